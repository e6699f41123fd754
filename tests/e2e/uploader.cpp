#include "uploader.h"

#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <zlib.h>

#include <algorithm>

#include "scene/builtin_scenes.h"

namespace caustream::e2e {

constexpr std::size_t kChunk = 100'000;

std::string builtinGlb(std::string_view name) {
    for (const scene::BuiltinScene& builtin : scene::builtinScenes()) {
        if (builtin.name == name) {
            return std::string(builtin.glb);
        }
    }
    return {};
}

std::string sha256(std::string_view bytes) {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned length = 0;
    EVP_Digest(bytes.data(), bytes.size(), digest, &length, EVP_sha256(), nullptr);
    std::string text;
    for (unsigned i = 0; i < length; ++i) {
        char byte[3];
        std::snprintf(byte, sizeof byte, "%02x", digest[i]);
        text += byte;
    }
    return text;
}

std::string padded(std::string file, std::uint32_t bytes) {
    const auto put = [&](std::size_t at, std::uint32_t value) {
        for (int i = 0; i < 4; ++i) {
            file[at + static_cast<std::size_t>(i)] = static_cast<char>(value >> (8 * i));
        }
    };
    const std::size_t old = file.size();
    file.resize(old + 8 + bytes, 'x');
    put(old, bytes);
    put(old + 4, 0x20202020);
    put(8, static_cast<std::uint32_t>(file.size()));
    return file;
}

std::vector<std::uint8_t> chunkOf(std::uint32_t asset, std::string_view file, std::size_t offset, std::size_t size) {
    const std::string_view payload = file.substr(offset, size);
    protocol::ChunkHeader header{.asset = asset, .offset = offset, .payloadLen = static_cast<std::uint32_t>(payload.size())};
    header.crc32 = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(payload.data()), static_cast<uInt>(payload.size())));
    const auto encoded = protocol::encodeHeader(header);
    std::vector<std::uint8_t> bytes(encoded.size() + payload.size());
    std::ranges::copy(encoded, bytes.begin());
    std::ranges::copy(payload, bytes.begin() + encoded.size());
    return bytes;
}

Json beginUpload(RawClient& viewer, std::string_view file, const std::string& hash) {
    return viewer.ask({{"op", "asset.begin"}, {"sha256", hash}, {"size", file.size()}, {"mime", "model/gltf-binary"}});
}

void sendChunks(RawClient& viewer, std::string_view file, const Json& offer) {
    const std::uint32_t asset = offer["asset"];
    std::size_t granted = offer["have"].get<std::size_t>() + offer["credit"].get<std::size_t>();
    for (std::size_t at = offer["have"]; at < file.size();) {
        const std::size_t size = std::min(kChunk, file.size() - at);
        while (at + size > granted) {
            const auto credit = viewer.textOf("asset.credit", 10'000);
            if (!credit) {
                ADD_FAILURE() << "no credit at byte " << at;
                return;
            }
            granted = (*credit)["have"].get<std::size_t>() + (*credit)["credit"].get<std::size_t>();
        }
        viewer.binary(chunkOf(asset, file, at, size));
        at += size;
    }
}

Json upload(RawClient& viewer, std::string_view file, const std::string& hash) {
    const Json offer = beginUpload(viewer, file, hash);
    EXPECT_EQ(offer["op"], "ok") << offer;
    sendChunks(viewer, file, offer);
    return viewer.ask({{"op", "asset.end"}, {"asset", offer["asset"]}});
}

Json upload(RawClient& viewer, std::string_view file) { return upload(viewer, file, sha256(file)); }

}  // namespace caustream::e2e
