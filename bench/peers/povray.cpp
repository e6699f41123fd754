#include "bench/peers/povray.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "error.h"

extern char** environ;

namespace caustream::peers {

namespace {

namespace fs = std::filesystem;

const std::string kProgram = "povray";

// A folder under the system's temporary one, with all that is in it.
class Folder {
   public:
    Folder() {
        std::string name = (fs::temp_directory_path() / "caustream-povray-XXXXXX").string();
        if (!::mkdtemp(name.data())) throw Error("cannot make a folder in " + fs::temp_directory_path().string());
        path_ = name;
    }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::string file(const char* name) const { return (path_ / name).string(); }

   private:
    fs::path path_;
};

struct Ended {
    int status = 0;
    double cpuSeconds = 0, seconds = 0;
};

double secondsOf(const timeval& time) { return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec); }

// Runs to the end, what it prints into `log`.
Ended runToEnd(std::vector<std::string> arguments, const std::string& log) {
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    const auto start = std::chrono::steady_clock::now();
    pid_t pid = 0;
    const int error = ::posix_spawnp(&pid, pointers[0], &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw Error("cannot start " + arguments[0]);
    Ended ended;
    rusage used{};
    if (::wait4(pid, &ended.status, 0, &used) != pid) throw Error("lost sight of " + arguments[0]);
    ended.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ended.cpuSeconds = secondsOf(used.ru_utime) + secondsOf(used.ru_stime);
    return ended;
}

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// The number after `label` in what POV-Ray printed; 0 where it says nothing.
std::uint64_t numberAfter(const std::string& text, const std::string& label) {
    const std::size_t at = text.find(label);
    return at == std::string::npos ? 0 : std::strtoull(text.c_str() + at + label.size(), nullptr, 10);
}

// Netpbm's P6 with two bytes a channel, big endian.
void readPpm(const std::string& bytes, PovrayImage& image) {
    std::istringstream in(bytes);
    std::string magic;
    int width = 0, height = 0, most = 0;
    const auto next = [&](auto& value) {
        in >> std::ws;
        while (in.peek() == '#') in.ignore(1 << 20, '\n'), in >> std::ws;
        in >> value;
    };
    next(magic), next(width), next(height), next(most);
    const auto first = static_cast<std::size_t>(in.tellg()) + 1;
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (!in || magic != "P6" || width != image.side || height != image.side || most != 65535 || bytes.size() < first + 6 * pixels) {
        throw Error("POV-Ray wrote a picture that is not a 16-bit PPM of " + std::to_string(image.side) + " pixels a side");
    }
    for (std::size_t i = 0; i < pixels; ++i) {
        const auto byte = [&](std::size_t k) { return static_cast<unsigned>(static_cast<unsigned char>(bytes[first + 6 * i + 2 + k])); };
        const unsigned value = 256 * byte(0) + byte(1);
        image.clipped = image.clipped || value == 65535;
        image.green.push_back(value / 65535.0);
    }
}

}  // namespace

bool havePovray() {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        if (::access((folder + "/" + kProgram).c_str(), X_OK) == 0) return true;
    }
    return false;
}

PovrayImage runPovray(const std::string& scene, int side, int threads) {
    const Folder folder;
    std::ofstream(folder.file("scene.pov")) << scene;
    const std::string pixels = std::to_string(side);
    const Ended ended = runToEnd({kProgram, "+I" + folder.file("scene.pov"), "+O" + folder.file("scene.ppm"), "+FP16", "+W" + pixels, "+H" + pixels, "-A", "-D",
                                  "+WT" + std::to_string(threads), "File_Gamma=1.0"},
                                 folder.file("log"));
    const std::string log = contents(folder.file("log"));
    if (!WIFEXITED(ended.status) || WEXITSTATUS(ended.status) != 0) throw Error("POV-Ray failed: " + log.substr(log.size() > 800 ? log.size() - 800 : 0));
    PovrayImage image{.side = side, .green = {}, .cpuSeconds = ended.cpuSeconds, .seconds = ended.seconds};
    image.shot = numberAfter(log, "photons shot:"), image.stored = numberAfter(log, "photons stored:");
    readPpm(contents(folder.file("scene.ppm")), image);
    return image;
}

}  // namespace caustream::peers
