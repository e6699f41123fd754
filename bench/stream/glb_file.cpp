#include "bench/stream/glb_file.h"

#include <algorithm>

#include "bench/stream/mutation.h"
#include "client/connection/upload.h"
#include "error.h"
#include "scene/builtin_scenes.h"

namespace caustream::bench {

using protocol::Json;

std::string builtinGlb(std::string_view scene) {
    for (const scene::BuiltinScene& builtin : scene::builtinScenes()) {
        if (builtin.name == scene) return std::string(builtin.glb);
    }
    throw Error("no built-in scene " + std::string(scene) + "; caustream-shot --help lists them");
}

std::string salted(const std::string& glb, std::uint64_t salt) {
    std::string file = glb;
    const auto append = [&](std::uint64_t value, int bytes) {
        for (int i = 0; i < bytes; ++i) file += static_cast<char>(value >> (8 * i));
    };
    append(8, 4);
    append(0x20202020, 4);
    append(salt, 8);
    for (int i = 0; i < 4; ++i) file[static_cast<std::size_t>(8 + i)] = static_cast<char>(file.size() >> (8 * i));
    return file;
}

std::string sha256(const std::string& bytes) {
    return connection::sha256Hex({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

Json upload(e2e::RawClient& client, const std::string& file, std::size_t chunkBytes) {
    const Json offer = client.ask({{"op", "asset.begin"}, {"sha256", sha256(file)}, {"size", file.size()}, {"mime", "model/gltf-binary"}});
    if (offer.value("op", "") != "ok") return offer;
    const std::uint32_t asset = offer.at("asset");
    std::size_t granted = offer.at("have").get<std::size_t>() + offer.at("credit").get<std::size_t>();
    for (std::size_t at = offer.at("have"); at < file.size();) {
        const std::size_t size = std::min(chunkBytes, file.size() - at);
        while (at + size > granted) {
            const auto credit = client.textOf("asset.credit", 20'000);
            if (!credit) return nullptr;
            granted = credit->at("have").get<std::size_t>() + credit->at("credit").get<std::size_t>();
        }
        const std::string chunk = validChunk(asset, at, file.substr(at, size));
        client.send(0x2, chunk);
        at += size;
    }
    return client.ask({{"op", "asset.end"}, {"asset", asset}});
}

}  // namespace caustream::bench
