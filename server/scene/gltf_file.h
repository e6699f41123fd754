// tinygltf's view of a GLB, with nothing outside it ever opened and no image decoded yet.
#pragma once
#include <tiny_gltf.h>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "scene/gltf_loader.h"

namespace caustream::scene {

struct GltfFile {
    tinygltf::Model model;
    std::map<int, std::vector<std::uint8_t>> inlineImages;  // image index -> PNG or JPEG of a data: URI
};

// Refuses what the loader cannot honour: outside files, required extensions it does not know. Names have 64 bytes at most.
tl::expected<GltfFile, LoadError> parseGltf(std::span<const std::byte> glb);

// `size` bytes of a buffer view from `offset`; an error that names `what` when they are not there.
tl::expected<std::span<const std::uint8_t>, LoadError> viewBytes(const tinygltf::Model& model, int view,
                                                                 const std::string& what);

// At most `maxBytes` of UTF-8, whole characters.
void cutText(std::string& text, std::size_t maxBytes);

// A member of an object value, or nullptr: tinygltf's own Get asserts.
const tinygltf::Value* member(const tinygltf::Value& object, const std::string& key);
const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const std::string& name);
// A finite number, or the fallback.
double numberOr(const tinygltf::Value* value, double fallback);
// The finite numbers of an array; empty when it is anything else.
std::vector<double> numbers(const tinygltf::Value* value);

}  // namespace caustream::scene
