// A copy of the embedded shaders in a folder of its own, to which a test adds programs.
#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "embedded/shaders.h"

namespace caustream::tests {

class ShaderFolder {
   public:
    explicit ShaderFolder(const std::string& name) : path_(std::filesystem::temp_directory_path() / (name + "-" + std::to_string(getpid()))) {
        for (const embedded::File& file : embedded::shaders()) write(std::string(file.name), std::string(file.bytes));
    }
    ~ShaderFolder() { std::filesystem::remove_all(path_); }
    ShaderFolder(const ShaderFolder&) = delete;
    ShaderFolder& operator=(const ShaderFolder&) = delete;

    void write(const std::string& file, const std::string& text) const {
        std::filesystem::create_directories((path_ / file).parent_path());
        std::ofstream(path_ / file, std::ios::binary) << text;
    }
    const std::filesystem::path& path() const { return path_; }

   private:
    std::filesystem::path path_;
};

}  // namespace caustream::tests
