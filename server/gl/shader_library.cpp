#include "gl/shader_library.h"

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

#include "embedded/shaders.h"

namespace caustream::gl {

namespace {

struct Stage {
    const char* ending;
    GLenum kind;
};
constexpr Stage kStages[] = {{".comp", GL_COMPUTE_SHADER},
                             {".vert", GL_VERTEX_SHADER},
                             {".geom", GL_GEOMETRY_SHADER},
                             {".frag", GL_FRAGMENT_SHADER}};

// Drivers begin a message with the source's number: "2:14(5): error" (Mesa), "2(14) : error" (NVIDIA),
// "ERROR: 2:14:" (others). The number becomes the file it stands for.
std::string nameFiles(const std::string& log, const std::vector<std::string>& files) {
    static const std::regex kPlace(R"((^|\n)(ERROR: |WARNING: )?(\d+)(:(\d+)|\((\d+)\)))");
    std::string out;
    auto rest = log.cbegin();
    for (std::sregex_iterator it(log.begin(), log.end(), kPlace), end; it != end; ++it) {
        const std::smatch& match = *it;
        out.append(rest, match[0].first);
        const std::size_t source = std::stoul(match[3].str());
        const std::string line = match[5].matched ? match[5].str() : match[6].str();
        out += match[1].str() + (source < files.size() ? files[source] : match[3].str()) + ":" + line;
        rest = match[0].second;
    }
    out.append(rest, log.cend());
    while (!out.empty() && (out.back() == '\n' || out.back() == '\0')) out.pop_back();
    return out;
}

std::string keyOf(std::string_view stem, const std::vector<Flag>& flags) {
    std::string key(stem);
    for (const Flag& flag : flags) key += " " + flag.name + "=" + std::to_string(flag.value);
    return key;
}

std::filesystem::file_time_type newestBelow(const std::filesystem::path& directory) {
    auto newest = std::filesystem::file_time_type::min();   // not {}: the clock's epoch may lie ahead of every file
    for (const auto& entry : std::filesystem::recursive_directory_iterator(directory)) {
        if (entry.is_regular_file()) newest = std::max(newest, entry.last_write_time());
    }
    return newest;
}

}  // namespace

ShaderLibrary::ShaderLibrary(std::filesystem::path directory) : directory_(std::move(directory)) {
    if (directory_.empty()) return;
    if (!std::filesystem::is_directory(directory_)) {
        throw ShaderError("no shader directory " + directory_.string() + "; give the folder that holds passes/ and common/");
    }
    newest_ = newestBelow(directory_);
}

bool ShaderLibrary::exists(const std::string& path) const {
    if (!directory_.empty()) return std::filesystem::exists(directory_ / path);
    const auto files = embedded::shaders();
    return std::any_of(files.begin(), files.end(), [&](const embedded::File& file) { return file.name == path; });
}

std::string ShaderLibrary::read(const std::string& path) const {
    if (directory_.empty()) {
        for (const embedded::File& file : embedded::shaders()) {
            if (file.name == path) return std::string(file.bytes);
        }
    } else if (std::ifstream in(directory_ / path, std::ios::binary); in) {
        std::ostringstream text;
        text << in.rdbuf();
        return text.str();
    }
    throw ShaderError("no shader " + path);
}

std::string ShaderLibrary::expand(const std::string& path, std::vector<std::string>& files) const {
    std::vector<std::string> open;
    return expand(path, files, open);
}

// `open`: the files that led here, each by an #include that is not finished.
std::string ShaderLibrary::expand(const std::string& path, std::vector<std::string>& files, std::vector<std::string>& open) const {
    const std::size_t source = files.size();
    files.push_back(path);
    open.push_back(path);
    std::istringstream in(read(path));
    std::string out = "#line 1 " + std::to_string(source) + "\n", line;
    for (int number = 1; std::getline(in, line); ++number) {
        static const std::regex kInclude(R"(^\s*#include\s+"([^"]+)\"\s*$)");
        std::smatch match;
        if (!std::regex_match(line, match, kInclude)) {
            out += line + "\n";
            continue;
        }
        const std::string included = match[1].str();
        if (!exists(included)) throw ShaderError(path + ":" + std::to_string(number) + ": no shader " + included);
        if (std::find(open.begin(), open.end(), included) != open.end()) {
            throw ShaderError(path + ":" + std::to_string(number) + ": " + included + " includes itself through this line");
        }
        // Once by default: a file already in the list is not pasted again.
        if (std::find(files.begin(), files.end(), included) == files.end()) out += expand(included, files, open);
        out += "#line " + std::to_string(number + 1) + " " + std::to_string(source) + "\n";
    }
    open.pop_back();
    return out;
}

Shader ShaderLibrary::compile(GLenum stage, const std::string& path, const std::vector<Flag>& flags) const {
    std::vector<std::string> files;
    std::string text = "#version 450 core\n";
    for (const Flag& flag : flags) text += "#define " + flag.name + " " + std::to_string(flag.value) + "\n";
    text += expand(path, files);

    Shader shader(glCreateShader(stage));
    const char* pointer = text.c_str();
    glShaderSource(shader.get(), 1, &pointer, nullptr);
    glCompileShader(shader.get());
    GLint ok = 0;
    glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &ok);
    if (!ok) {
        GLint length = 0;
        glGetShaderiv(shader.get(), GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
        glGetShaderInfoLog(shader.get(), length, nullptr, log.data());
        throw ShaderError("shader " + path + " does not compile: " + nameFiles(log, files));
    }
    return shader;
}

GLuint ShaderLibrary::program(std::string_view stem, const std::vector<Flag>& flags) {
    std::string key = keyOf(stem, flags);
    if (const auto found = programs_.find(key); found != programs_.end()) return found->second.get();

    const std::string base = "passes/" + std::string(stem);
    Program program(glCreateProgram());
    std::vector<Shader> shaders;
    for (const Stage& stage : kStages) {
        if (!exists(base + stage.ending)) continue;
        shaders.push_back(compile(stage.kind, base + stage.ending, flags));
        glAttachShader(program.get(), shaders.back().get());
    }
    if (shaders.size() == 1 && exists(base + ".frag")) {  // image-space pass: the one triangle that covers the target
        shaders.push_back(compile(GL_VERTEX_SHADER, "common/fullscreen.vert", {}));
        glAttachShader(program.get(), shaders.back().get());
    }
    if (shaders.empty()) throw ShaderError("no shader " + base + ".comp or .vert");
    glLinkProgram(program.get());
    GLint ok = 0;
    glGetProgramiv(program.get(), GL_LINK_STATUS, &ok);
    if (!ok) {
        GLint length = 0;
        glGetProgramiv(program.get(), GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
        glGetProgramInfoLog(program.get(), length, nullptr, log.data());
        throw ShaderError("program " + key + " does not link: " + nameFiles(log, {}));
    }
    for (const Shader& shader : shaders) glDetachShader(program.get(), shader.get());
    glObjectLabel(GL_PROGRAM, program.get(), static_cast<GLsizei>(key.size()), key.data());
    return programs_.emplace(std::move(key), std::move(program)).first->second.get();
}

bool ShaderLibrary::reloadIfChanged() {
    if (directory_.empty()) return false;
    const auto newest = newestBelow(directory_);
    if (newest == newest_) return false;
    newest_ = newest;
    programs_.clear();
    return true;
}

}  // namespace caustream::gl
