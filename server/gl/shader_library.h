// Programs by name: "photon_trace" is shaders/passes/photon_trace.comp, or .vert, .geom and .frag
// (common/fullscreen.vert where a .frag stands alone). Resolves #include
// "common/x.glsl", once each; driver messages come back as file:line. Compiled once per set of flags.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "error.h"
#include "gl/names.h"

namespace caustream::gl {

// A shader that does not compile or link: file:line and the driver's words.
struct ShaderError : Error {
    using Error::Error;
};

struct Flag {                       // becomes `#define NAME value`; shaders say `#if NAME`
    std::string name;
    int value = 1;
};

class ShaderLibrary {
   public:
    // Reads the shaders embedded in the program, or those below `directory` when it is given.
    explicit ShaderLibrary(std::filesystem::path directory = {});

    // The program for `stem` with `flags`, compiled on first use. Throws ShaderError.
    GLuint program(std::string_view stem, const std::vector<Flag>& flags = {});

    // With a directory: drops programs if a file changed, so that the next use compiles anew. True if it did.
    bool reloadIfChanged();

    // A shader's text with its includes in place; throws ShaderError (missing file, cycle). Public for tests.
    std::string expand(const std::string& path, std::vector<std::string>& files) const;

   private:
    std::string read(const std::string& path) const;
    std::string expand(const std::string& path, std::vector<std::string>& files, std::vector<std::string>& open) const;
    bool exists(const std::string& path) const;
    Shader compile(GLenum stage, const std::string& path, const std::vector<Flag>& flags) const;

    std::filesystem::path directory_;
    std::filesystem::file_time_type newest_{};
    std::map<std::string, Program, std::less<>> programs_;
};

}  // namespace caustream::gl
