#include "scene/gltf_outline.h"

#include <nlohmann/json.hpp>

namespace caustream::scene {

namespace {

using Json = nlohmann::json;

// The library's structs have 300 to 2200 bytes: some 150 MB if a file uses all of this up.
struct Most {
    const char* list;
    std::size_t entries;
};
constexpr Most kMost[] = {{"accessors", 100'000}, {"bufferViews", 100'000}, {"nodes", 100'000}, {"meshes", 50'000},
                          {"materials", 4096},    {"images", 4096},         {"textures", 4096}, {"samplers", 4096},
                          {"animations", 4096},   {"skins", 4096},          {"cameras", 256},   {"scenes", 256},
                          {"buffers", 64}};
constexpr Most kMostParts[] = {{"primitives", 100'000}, {"channels", 50'000}, {"samplers", 50'000}};  // of all meshes, animations
constexpr std::size_t kMostLights = 256;

tl::unexpected<LoadError> fail(std::string message) { return tl::unexpected(LoadError{std::move(message)}); }

tl::unexpected<LoadError> tooMany(std::size_t count, std::size_t most, const char* list) {
    return fail("the file lists " + std::to_string(count) + " " + list + "; " + std::to_string(most) + " are allowed");
}

const Json& member(const Json& object, const char* key) {
    static const Json none;
    const auto found = object.is_object() ? object.find(key) : object.end();
    return object.is_object() && found != object.end() ? *found : none;
}

std::size_t partsOf(const Json& root, const char* part) {
    std::size_t parts = 0;
    for (const char* owner : {"meshes", "animations"})
        if (const Json& owners = member(root, owner); owners.is_array())
            for (const Json& one : owners) parts += member(one, part).size();
    return parts;
}

}  // namespace

tl::expected<void, LoadError> checkOutline(std::string_view json) {
    const Json root = Json::parse(json, nullptr, false);
    if (root.is_discarded()) return fail("the glTF cannot be read: its JSON has an error");
    for (const auto& [list, entries] : kMost)
        if (const std::size_t count = member(root, list).size(); count > entries) return tooMany(count, entries, list);
    for (const auto& [part, entries] : kMostParts)
        if (const std::size_t count = partsOf(root, part); count > entries) return tooMany(count, entries, part);
    if (const std::size_t count = member(member(member(root, "extensions"), "KHR_lights_punctual"), "lights").size(); count > kMostLights)
        return tooMany(count, kMostLights, "lights");

    // glTF 2.0, section 4.4.3.2: the first buffer may be the binary chunk. The library copies the chunk for every other.
    if (const Json& buffers = member(root, "buffers"); buffers.is_array())
        for (std::size_t i = 1; i < buffers.size(); ++i)
            if (const Json& uri = member(buffers[i], "uri"); !uri.is_string() || uri.get_ref<const std::string&>().empty())
                return fail("buffer " + std::to_string(i) + " has no uri; only the first may be the binary chunk");
    return {};
}

}  // namespace caustream::scene
