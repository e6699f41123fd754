// Every shader with every variant, and what the library says when one is wrong.
#include <regex>
#include <set>

#include "tests/gpu/camera_fixture.h"
#include "tests/gpu/shader_folder.h"

namespace caustream::tests {
namespace {

using testing::HasSubstr;

class ShaderLibraryTest : public CameraPass {
   protected:
    // Names that the text's #if lines ask about and that are not its own; each with how many values it takes.
    static std::map<std::string, int> flagsOf(const std::string& text) {
        std::map<std::string, int> flags;
        static const std::regex kCondition(R"(#(?:if|elif)[^\n]*)"), kName(R"(\b[A-Z][A-Z0-9_]*\b(?:\s*==\s*(\d+))?)");
        for (std::sregex_iterator line(text.begin(), text.end(), kCondition), end; line != end; ++line) {
            const std::string condition = line->str();
            for (std::sregex_iterator name(condition.begin(), condition.end(), kName); name != end; ++name) {
                const std::string word = std::regex_replace(name->str(), std::regex(R"(\W.*)"), "");
                const int values = (*name)[1].matched ? std::stoi((*name)[1].str()) + 2 : 2;   // each value asked for, and another
                flags[word] = std::max(flags[word], values);
            }
        }
        return flags;
    }

    using Variant = std::vector<gl::Flag>;
    static int valueOf(const Variant& variant, const std::string& name) {
        const auto flag = std::find_if(variant.begin(), variant.end(), [&](const gl::Flag& f) { return f.name == name; });
        return flag == variant.end() ? -1 : flag->value;
    }

    // What exact_surfaces.h and camera_paths.cpp ask for; other combinations do not hold together.
    static bool possible(const std::string& stem, const Variant& variant) {
        const auto set = [&](const char* name) { return valueOf(variant, name) > 0; };
        if (set("LONE") && (!set("PLANES") || set("MESHES"))) return false;
        if (set("DRAWN") && !set("LONE")) return false;
        return stem != "camera_paths" || (set("EXACT_RECEIVERS") && set("RAYS"));
    }

    // Of a program with very many variants: each form of the casters with none, one or all of the other parts.
    static bool chosen(const Variant& variant) {
        static const std::set<std::string> kForms = {"PLANES", "MESHES", "LONE", "DRAWN", "EXACT_RECEIVERS", "RAYS"};
        std::size_t parts = 0, on = 0;
        for (const gl::Flag& flag : variant) {
            if (kForms.contains(flag.name)) continue;
            ++parts;
            on += flag.value > 0;
        }
        return on <= 1 || on == parts;
    }

    std::string errorOf(const ShaderFolder& folder, const std::string& stem) {
        gl::ShaderLibrary library(folder.path());
        try {
            library.program(stem);
        } catch (const gl::ShaderError& error) {
            return error.what();
        }
        return "";
    }
};

TEST_F(ShaderLibraryTest, EveryShaderCompilesInEveryVariant) {
    std::map<std::string, std::map<std::string, int>> stems;
    for (const embedded::File& file : embedded::shaders()) {
        const std::string name(file.name);
        if (!name.starts_with("passes/")) continue;
        std::vector<std::string> files;
        stems[name.substr(7, name.rfind('.') - 7)].merge(flagsOf(shaders_.expand(name, files)));
    }
    EXPECT_GE(stems.size(), 10u);
    int programs = 0;
    for (const auto& [stem, names] : stems) {
        std::vector<std::vector<gl::Flag>> variants = {{}};
        for (const auto& [name, values] : names) {
            std::vector<std::vector<gl::Flag>> next;
            for (const auto& variant : variants) {
                for (int value = 0; value < values; ++value) {
                    next.push_back(variant);
                    next.back().push_back({name, value});
                }
            }
            variants.swap(next);
        }
        std::erase_if(variants, [&, name = stem](const Variant& variant) { return !possible(name, variant); });
        if (variants.size() > 48) std::erase_if(variants, [](const Variant& variant) { return !chosen(variant); });
        for (const auto& variant : variants) {
            EXPECT_NO_THROW(shaders_.program(stem, variant)) << stem;
            ++programs;
        }
    }
    EXPECT_GE(programs, 30);
}

TEST_F(ShaderLibraryTest, ErrorsNameFileAndLine) {
    const ShaderFolder folder("caustream-shader-errors");
    folder.write("common/wrong.glsl", "// fine\nfloat half_(float x) { return 0.5 * x; }\nfloat wrong() { return undeclared; }\n");
    folder.write("passes/included.comp", "#include \"common/view.glsl\"\n#include \"common/wrong.glsl\"\nlayout(local_size_x = 1) in;\nvoid main() {}\n");
    EXPECT_THAT(errorOf(folder, "included"), HasSubstr("common/wrong.glsl:3"));

    folder.write("passes/after.comp", "#include \"common/view.glsl\"\nlayout(local_size_x = 1) in;\nvoid main() {\n    undeclared = 1;\n}\n");
    EXPECT_THAT(errorOf(folder, "after"), HasSubstr("passes/after.comp:4"));
    EXPECT_THAT(gl::takeDebugMessages(), testing::Not(testing::IsEmpty()));   // the driver says it there too
}

TEST_F(ShaderLibraryTest, MissingFilesAreNamed) {
    const ShaderFolder folder("caustream-shader-missing");
    EXPECT_THAT(errorOf(folder, "nowhere"), HasSubstr("passes/nowhere"));
    folder.write("passes/asks.comp", "\n#include \"common/nowhere.glsl\"\nvoid main() {}\n");
    EXPECT_THAT(errorOf(folder, "asks"), testing::AllOf(HasSubstr("passes/asks.comp:2"), HasSubstr("common/nowhere.glsl")));
    EXPECT_THROW(gl::ShaderLibrary(folder.path() / "no such folder"), gl::ShaderError);
}

TEST_F(ShaderLibraryTest, AnIncludeCycleIsAnError) {
    const ShaderFolder folder("caustream-shader-cycle");
    folder.write("common/a.glsl", "#include \"common/b.glsl\"\n");
    folder.write("common/b.glsl", "float b;\n#include \"common/a.glsl\"\n");
    folder.write("passes/cycle.comp", "#include \"common/a.glsl\"\nlayout(local_size_x = 1) in;\nvoid main() {}\n");
    EXPECT_THAT(errorOf(folder, "cycle"), testing::AllOf(HasSubstr("common/b.glsl:2"), HasSubstr("common/a.glsl")));
    folder.write("passes/self.comp", "#include \"passes/self.comp\"\nvoid main() {}\n");
    EXPECT_THAT(errorOf(folder, "self"), HasSubstr("passes/self.comp:1"));
}

TEST_F(ShaderLibraryTest, AChangedFileIsCompiledAnew) {
    const ShaderFolder folder("caustream-shader-reload");
    folder.write("passes/changing.comp", "layout(local_size_x = 1) in;\nvoid main() {}\n");
    gl::ShaderLibrary library(folder.path());
    library.program("changing");
    EXPECT_FALSE(library.reloadIfChanged());
    folder.write("passes/changing.comp", "layout(local_size_x = 1) in;\nvoid main() { wrong; }\n");
    std::filesystem::last_write_time(folder.path() / "passes/changing.comp",
                                     std::filesystem::file_time_type::clock::now() + std::chrono::seconds(2));
    EXPECT_TRUE(library.reloadIfChanged());
    EXPECT_THROW(library.program("changing"), gl::ShaderError);
    gl::takeDebugMessages();   // of the wrong shader
}

}  // namespace
}  // namespace caustream::tests
