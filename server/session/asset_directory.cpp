#include "session/asset_directory.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include "error.h"
#include "session/random_id.h"

namespace caustream::session {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPartSuffix = ".part";  // of a file that is being written
constexpr auto kForgottenAfter = std::chrono::hours(1);  // by a server that ended while it wrote

class File {
   public:
    File(const fs::path& path, int flags) : descriptor_(open(path.c_str(), flags | O_CLOEXEC | O_NOFOLLOW, 0640)) {}
    ~File() {
        if (descriptor_ >= 0) {
            close(descriptor_);
        }
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    int get() const { return descriptor_; }

   private:
    int descriptor_;
};

// The name comes from outside.
bool isHash(const std::string& name) {
    return name.size() == 64 && std::ranges::all_of(name, [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

std::string sha256Of(std::span<const std::byte> bytes) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned length = 0;
    EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr);
    return hex({digest.data(), length});
}

bool writeAll(int file, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(file, bytes.data(), bytes.size());
        if (written < 0 && errno != EINTR) {
            return false;
        }
        bytes = bytes.subspan(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
    }
    return true;
}

tl::unexpected<std::string> failure(const std::string& what, const fs::path& where) {
    return tl::unexpected(what + " " + where.string() + ": " + std::strerror(errno));
}

}  // namespace

AssetDirectory::AssetDirectory(fs::path folder, std::size_t budgetBytes, std::size_t maxFileBytes)
    : folder_(std::move(folder)), budgetBytes_(budgetBytes), maxFileBytes_(maxFileBytes) {
    std::error_code problem;
    fs::create_directories(folder_, problem);
    if (problem || access(folder_.c_str(), R_OK | W_OK | X_OK) != 0) {
        throw Error("asset directory; cannot write to " + folder_.string() + "; check the path and who owns it");
    }
}

bool AssetDirectory::contains(const std::string& sha256) const {
    struct stat status {};
    return isHash(sha256) && lstat(pathOf(sha256).c_str(), &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0 &&
           static_cast<std::size_t>(status.st_size) <= maxFileBytes_;
}

std::optional<std::vector<std::byte>> AssetDirectory::read(const std::string& sha256) const {
    if (!contains(sha256)) {
        return std::nullopt;
    }
    const File file(pathOf(sha256), O_RDONLY);
    struct stat status {};
    if (file.get() < 0 || fstat(file.get(), &status) != 0 || static_cast<std::size_t>(status.st_size) > maxFileBytes_) {
        return std::nullopt;
    }
    std::vector<std::byte> bytes(static_cast<std::size_t>(status.st_size));
    std::size_t have = 0;
    while (have < bytes.size()) {
        const ssize_t got = ::read(file.get(), bytes.data() + have, bytes.size() - have);
        if (got == 0 || (got < 0 && errno != EINTR)) {
            return std::nullopt;
        }
        have += static_cast<std::size_t>(std::max<ssize_t>(got, 0));
    }
    if (sha256Of(bytes) != sha256) {
        unlink(pathOf(sha256).c_str());
        return std::nullopt;
    }
    futimens(file.get(), nullptr);  // only its owner may: elsewhere it ages from when it was written
    return bytes;
}

tl::expected<void, std::string> AssetDirectory::write(const std::string& sha256, std::span<const std::byte> bytes) const {
    if (!isHash(sha256) || contains(sha256)) {
        return {};
    }
    const fs::path part = folder_ / (randomId() + std::string(kPartSuffix));
    {
        const File file(part, O_WRONLY | O_CREAT | O_EXCL);
        if (file.get() < 0) {
            return failure("cannot make", part);
        }
        if (!writeAll(file.get(), bytes) || fsync(file.get()) != 0) {
            auto problem = failure("cannot write", part);
            unlink(part.c_str());
            return problem;
        }
    }
    if (rename(part.c_str(), pathOf(sha256).c_str()) != 0) {
        auto problem = failure("cannot name", pathOf(sha256));
        unlink(part.c_str());
        return problem;
    }
    if (const File folder(folder_, O_RDONLY | O_DIRECTORY); folder.get() >= 0) {
        fsync(folder.get());  // the name, too, survives a power cut
    }
    keepToBudget(pathOf(sha256));
    return {};
}

// Another server may remove the same files at the same time: whatever is gone already is no error.
void AssetDirectory::keepToBudget(const fs::path& newest) const {
    struct Found {
        fs::file_time_type time;
        std::size_t bytes;
        fs::path path;
    };
    std::vector<Found> files;
    std::size_t total = 0;
    std::error_code problem;
    const auto now = fs::file_time_type::clock::now();
    for (auto entry = fs::directory_iterator(folder_, problem); !problem && entry != fs::directory_iterator(); entry.increment(problem)) {
        std::error_code gone;
        const fs::path& path = entry->path();
        const auto time = entry->last_write_time(gone);
        if (gone || !entry->is_regular_file(gone)) {
            continue;
        }
        if (path.extension() == kPartSuffix && now - time > kForgottenAfter) {
            fs::remove(path, gone);
        } else if (path.extension() == ".glb" && isHash(path.stem())) {
            const std::size_t bytes = entry->file_size(gone);
            total += gone ? 0 : bytes;
            files.push_back({time, gone ? 0 : bytes, path});
        }
    }
    std::ranges::sort(files, {}, &Found::time);
    for (const Found& file : files) {
        if (total <= budgetBytes_) {
            break;
        }
        if (file.path != newest) {
            std::error_code gone;
            fs::remove(file.path, gone);
            total -= file.bytes;
        }
    }
}

}  // namespace caustream::session
