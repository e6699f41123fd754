#include "scene/glb_container.h"

#include <cstdint>
#include <string_view>

#include "scene/gltf_outline.h"

namespace caustream::scene {

namespace {

constexpr std::uint32_t kGlbMagic = 0x46546C67, kJsonChunk = 0x4E4F534A,
                        kBinChunk = 0x004E4942;  // "glTF", "JSON", "BIN"
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
constexpr int kMaxJsonDepth = 64;                // the glTF library recurses
constexpr std::size_t kMaxJsonValues = 500'000;  // and keeps some 250 bytes a value

std::uint32_t wordAt(std::span<const std::byte> bytes, std::size_t offset) {
    std::uint32_t word = 0;
    for (int i = 3; i >= 0; --i) word = word << 8 | std::to_integer<std::uint32_t>(bytes[offset + i]);
    return word;
}

tl::unexpected<LoadError> fail(std::string message) {
    return tl::unexpected(LoadError{std::move(message)});
}

tl::expected<void, LoadError> checkJson(std::string_view json) {
    int depth = 0;
    std::size_t values = 0;
    bool inString = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (inString) {
            if (c == '\\') ++i;
            if (c == '"') inString = false;
            continue;
        }
        if (c == '"') inString = true;
        if (c == '{' || c == '[') {
            ++values;
            if (++depth > kMaxJsonDepth) return fail("the JSON is nested deeper than " + std::to_string(kMaxJsonDepth));
        }
        if (c == '}' || c == ']') --depth;
        if (c == ',' && ++values > kMaxJsonValues)
            return fail("the JSON has more than " + std::to_string(kMaxJsonValues) + " values");
    }
    return {};
}

}  // namespace

tl::expected<void, LoadError> checkContainer(std::span<const std::byte> glb, const LoadLimits& limits) {
    if (glb.size() > limits.bytes)
        return fail("the file has " + std::to_string(glb.size()) + " bytes; " + std::to_string(limits.bytes) +
                    " are allowed");
    if (glb.size() < kHeaderBytes + kChunkHeaderBytes) return fail("the file is too short for a GLB header");
    if (wordAt(glb, 0) != kGlbMagic) return fail("the file is not a GLB: it does not begin with \"glTF\"");
    if (const auto version = wordAt(glb, 4); version != 2)
        return fail("the GLB has version " + std::to_string(version) + "; only 2 is supported");
    const std::size_t length = wordAt(glb, 8);
    if (length != glb.size())
        return fail("the GLB header says " + std::to_string(length) + " bytes, the file has " +
                    std::to_string(glb.size()));

    std::size_t offset = kHeaderBytes;
    for (int chunk = 0; offset < length; ++chunk) {
        const std::string name = "chunk " + std::to_string(chunk);
        if (length - offset < kChunkHeaderBytes) return fail(name + " is cut short in its header");
        const std::size_t size = wordAt(glb, offset);
        const std::uint32_t type = wordAt(glb, offset + 4);
        offset += kChunkHeaderBytes;
        if (size > length - offset)
            return fail(name + " says " + std::to_string(size) + " bytes, " + std::to_string(length - offset) +
                        " are left");
        if (size % 4 != 0) return fail(name + " has a length that is not a multiple of 4");
        if (chunk == 0 && type != kJsonChunk) return fail("the first chunk is not JSON");
        if (chunk == 1 && type != kBinChunk) return fail("the second chunk is not BIN");
        if (chunk == 0) {
            const auto* text = reinterpret_cast<const char*>(glb.data() + offset);
            if (auto ok = checkJson({text, size}); !ok) return ok;
            if (auto ok = checkOutline({text, size}); !ok) return ok;
        }
        offset += size;
    }
    return {};
}

}  // namespace caustream::scene
