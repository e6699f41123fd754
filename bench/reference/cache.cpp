// Results on disk: <SHA-256 of the input>.trace holds the SHA-256 of what follows it, then the result as raw bytes of
// this machine.
#include <openssl/evp.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <type_traits>

#include "bench/reference/tracer.h"
#include "error.h"

namespace caustream::tracer {

namespace {

// Part of every key. To be raised when the tracer gives other results for the same input.
constexpr int kVersion = 3;

using Digest = std::array<unsigned char, 32>;

Digest sha256(const std::string& bytes) {
    Digest digest{};
    if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), nullptr, EVP_sha256(), nullptr) != 1) {
        throw Error("SHA-256 is not available; check the installation of libcrypto");
    }
    return digest;
}

std::string hex(const Digest& digest) {
    std::string text;
    for (const unsigned char byte : digest) text += {"0123456789abcdef"[byte >> 4], "0123456789abcdef"[byte & 15]};
    return text;
}

// Values one after the other; an array is its length and its elements.
class Writer {
 public:
    template <class T>
    Writer& operator<<(const T& value) requires std::is_trivially_copyable_v<T> {
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
        return *this;
    }
    template <class T>
    Writer& operator<<(const std::vector<T>& values) {
        *this << values.size();
        if constexpr (std::is_trivially_copyable_v<T>) {
            bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        } else {
            for (const T& value : values) *this << value;
        }
        return *this;
    }
    Writer& operator<<(const Image& image) {
        return *this << image.columns << image.rows << image.channels << image.values << image.relativeL1;
    }
    Writer& operator<<(const Collected& collected) { return *this << collected.bands << collected.xyz; }
    const std::string& bytes() const { return bytes_; }

 private:
    std::string bytes_;
};

class Reader {
 public:
    explicit Reader(const std::string& bytes) : bytes_(bytes) {}

    template <class T>
    Reader& operator>>(T& value) requires std::is_trivially_copyable_v<T> {
        if (take(sizeof value)) std::memcpy(&value, bytes_.data() + at_ - sizeof value, sizeof value);
        return *this;
    }
    template <class T>
    Reader& operator>>(std::vector<T>& values) {
        std::size_t count = 0;
        *this >> count;
        if constexpr (std::is_trivially_copyable_v<T>) {
            if (count > bytes_.size() / sizeof(T) || !take(count * sizeof(T))) return ok_ = false, *this;
            values.resize(count);
            if (count > 0) std::memcpy(values.data(), bytes_.data() + at_ - count * sizeof(T), count * sizeof(T));
        } else {
            for (std::size_t i = 0; i < count && ok_; ++i) *this >> values.emplace_back();
        }
        return *this;
    }
    Reader& operator>>(Image& image) {
        return *this >> image.columns >> image.rows >> image.channels >> image.values >> image.relativeL1;
    }
    Reader& operator>>(Collected& collected) { return *this >> collected.bands >> collected.xyz; }
    bool complete() const { return ok_ && at_ == bytes_.size(); }

 private:
    bool take(std::size_t count) {
        ok_ = ok_ && count <= bytes_.size() - at_;
        if (ok_) at_ += count;
        return ok_;
    }

    const std::string& bytes_;
    std::size_t at_ = 0;
    bool ok_ = true;
};

void describe(Writer& key, const World& world) {
    for (const Glass& glass : world.glasses) {
        key << glass.dispersion.index();
        std::visit([&](const auto& dispersion) { key << dispersion; }, glass.dispersion);
        key << glass.absorption.nm << glass.absorption.perM << glass.priority << glass.mirror;
    }
    key << world.bodies.size();
    for (const Body& body : world.bodies) key << body.positions << body.normals << body.indices << body.glass;
    key << world.solids.size();
    for (const Solid& solid : world.solids) {
        key << solid.shape.index() << solid.glass;
        if (const auto* sphere = std::get_if<Sphere>(&solid.shape)) key << *sphere;
        if (const auto* planes = std::get_if<ConvexPlanes>(&solid.shape)) key << planes->planes;
    }
    const Light& light = world.light;
    key << light.type << light.position << light.direction << light.innerConeRad << light.outerConeRad << light.spectrum.index();
    if (const auto* body = std::get_if<optics::Blackbody>(&light.spectrum)) key << body->kelvin;
    if (const auto* lines = std::get_if<optics::Lines>(&light.spectrum)) key << lines->nm;
    key << light.cookie.width << light.cookie.height << light.cookie.luminance << world.outsideIndex;
}

// All that the result depends on; the number of threads is not among it.
std::string keyOf(const World& world, const Settings& settings) {
    Writer key;
    key << kVersion;
    describe(key, world);
    key << settings.wavelengthsNm << settings.continuousSamples << settings.observer << settings.photons << settings.maxInterfaces
        << settings.minWeight << settings.firstReflection << settings.windows.size();
    for (const Window& window : settings.windows) {
        key << window.origin << window.u << window.v << window.columns << window.rows << window.toleranceM;
    }
    key << settings.maps.size();
    for (const MapView& map : settings.maps) key << map.worldToClip << map.size;
    return hex(sha256(key.bytes()));
}

std::string pack(const Result& result) {
    Writer out;
    out << result.windows << result.maps << result.ledgers << result.continuous << result.hidden << result.worstClosure
        << result.extent << result.photons << result.hits << result.seconds;
    return out.bytes();
}

std::optional<Result> unpack(const std::string& bytes) {
    Result result;
    Reader in(bytes);
    in >> result.windows >> result.maps >> result.ledgers >> result.continuous >> result.hidden >> result.worstClosure >>
        result.extent >> result.photons >> result.hits >> result.seconds;
    if (!in.complete()) return std::nullopt;
    result.cached = true;
    return result;
}

std::optional<Result> load(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    Digest stored{};
    if (!stream.read(reinterpret_cast<char*>(stored.data()), static_cast<std::streamsize>(stored.size()))) return std::nullopt;
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    return sha256(bytes) == stored ? unpack(bytes) : std::nullopt;
}

void store(const std::filesystem::path& file, const Result& result) {
    const std::string bytes = pack(result);
    const Digest digest = sha256(bytes);
    // A name of this process, then renamed: nobody ever sees half a file.
    std::filesystem::path draft = file;
    draft += '.';
    draft += std::to_string(::getpid());
    std::ofstream stream(draft, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(digest.data()), static_cast<std::streamsize>(digest.size()));
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) {
        std::filesystem::remove(draft);
        throw Error("cannot write " + draft.string() + "; is there room?");
    }
    std::filesystem::rename(draft, file);
}

}  // namespace

Result traceCached(const std::string& folder, const World& world, const Settings& settings, const Progress& progress) {
    std::filesystem::create_directories(folder);
    const std::filesystem::path file = std::filesystem::path(folder) / keyOf(world, settings).append(".trace");
    if (auto result = load(file)) return std::move(*result);
    Result result = trace(world, settings, progress);
    store(file, result);
    return result;
}

}  // namespace caustream::tracer
