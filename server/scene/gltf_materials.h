// glTF materials, their extensions and extras.caustream (docs/units.md) -> Material and the textures they use.
#pragma once
#include <map>
#include <string>
#include <tl/expected.hpp>
#include <unordered_set>
#include <vector>

#include "scene/gltf_file.h"
#include "scene/scene.h"

namespace caustream::scene {

// Decodes each image once and numbers the textures in the order they are asked for.
class TextureTable {
 public:
    TextureTable(const GltfFile& file, std::size_t maxTexels) : file_(file), texelsLeft_(maxTexels) {}

    // Scene::textures index of a glTF texture.
    tl::expected<int, LoadError> use(int gltfTexture, const std::string& what);
    std::vector<Texture> take() { return std::move(textures_); }

 private:
    const GltfFile& file_;
    std::size_t texelsLeft_;
    std::map<int, int> ofImage_;
    std::vector<Texture> textures_;
};

// Names that stay the same from load to load: the file's own, "kind" or "kind-3" where it has none, and "name-3" where
// another has it already.
class NameTable {
 public:
    std::string unique(const std::string& name, const std::string& kind, std::size_t index);

 private:
    std::unordered_set<std::string> taken_;
};

// Where a material's base-colour texture takes its coordinates: the attribute set, and KHR_texture_transform.
struct UvSource {
    int set = 0;
    glm::dmat3 transform{1.0};  // of (u, v, 1)
};
UvSource uvSource(const tinygltf::Material& source);

tl::expected<Material, LoadError> readMaterial(const tinygltf::Material& source, TextureTable& textures,
                                               const std::string& name, std::vector<std::string>& warnings);

// The spectrum of extras.caustream of a light: ["E"], ["D65"], ["blackbody", K], ["lines", nm...].
tl::expected<optics::Spectrum, LoadError> readSpectrum(const tinygltf::Value& value, const std::string& what);

}  // namespace caustream::scene
