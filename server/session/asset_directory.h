// A folder of uploaded files, each named by its SHA-256, which several servers may share: what one was given, all have. A
// file appears whole or not at all. Any thread.
#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace caustream::session {

class AssetDirectory {
   public:
    // Makes the folder where there is none. Throws Error when it cannot be written to.
    AssetDirectory(std::filesystem::path folder, std::size_t budgetBytes, std::size_t maxFileBytes);

    // Whether there is a file of this name and a size that may be; what is in it, read() looks at.
    bool contains(const std::string& sha256) const;

    // The file, if its bytes have that hash. One that lies is removed. Reading makes it one of the newest.
    std::optional<std::vector<std::byte>> read(const std::string& sha256) const;

    // `bytes` were checked to have that hash. Then the oldest files go until the folder keeps to its budget. The error is a
    // sentence.
    tl::expected<void, std::string> write(const std::string& sha256, std::span<const std::byte> bytes) const;

   private:
    std::filesystem::path pathOf(const std::string& sha256) const { return folder_ / (sha256 + ".glb"); }
    void keepToBudget(const std::filesystem::path& newest) const;

    std::filesystem::path folder_;
    std::size_t budgetBytes_, maxFileBytes_;
};

}  // namespace caustream::session
