#include <cmath>
#include <glm/geometric.hpp>

#include "scene/gltf_loader.h"
#include "targets.h"

namespace caustream::fuzz {
namespace {

using namespace scene;

// Small, so that a run of the fuzzer is many files and not a few large ones.
constexpr LoadLimits kLimits{.bytes = 1u << 20, .triangles = 20'000, .texels = 1u << 18};

bool finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// What the renderer takes for granted: it reads these arrays on the GPU, where nothing is checked.
void requireSound(const Scene& scene) {
    const Geometry& geometry = *scene.geometry;
    for (const Vertex& vertex : geometry.vertices) {
        require(finite(vertex.position), "positions are finite");
        require(std::abs(glm::length(vertex.normal) - 1.0f) < 1e-3f, "normals have length 1");
        require(std::isfinite(vertex.uv.x) && std::isfinite(vertex.uv.y), "texture coordinates are finite");
    }
    for (const std::uint32_t index : geometry.indices) {
        require(index < geometry.vertices.size(), "indices are those of vertices");
    }
    require(!geometry.objects.empty() && geometry.indices.size() / 3 <= kLimits.triangles + 2, "some triangles, not too many");
    for (const Object& object : geometry.objects) {
        require(object.indexCount > 0 && object.indexCount % 3 == 0, "objects have triangles");
        require(std::size_t{object.firstIndex} + object.indexCount <= geometry.indices.size(), "objects lie within the indices");
        require(object.material >= 0 && std::size_t(object.material) < scene.materials.size(), "objects have a material");
        require(finite(object.bounds.min) && finite(object.bounds.max), "bounds are finite");
    }
    std::size_t texels = 0;
    for (const Texture& texture : geometry.textures) {
        require(texture.width > 0 && texture.height > 0, "textures have texels");
        require(texture.rgba.size() == std::size_t(texture.width) * texture.height * 4, "textures are whole");
        texels += texture.rgba.size() / 4;
    }
    require(texels <= kLimits.texels, "textures keep to the limit");
    const auto isTexture = [&](int index) { return index >= -1 && index < int(geometry.textures.size()); };
    for (const Material& material : scene.materials) {
        require(!material.name.empty() && isTexture(material.baseColorTexture), "materials have a name and their texture");
        require(finite(material.emissive), "emission is finite");
    }
    require(!scene.lights.empty() && !scene.cameras.empty(), "there is a light and a camera");
    for (const Light& light : scene.lights) {
        require(finite(light.position) && finite(light.color) && std::isfinite(light.intensity), "lights are finite");
        require(std::abs(glm::length(light.direction) - 1.0f) < 1e-3f && isTexture(light.cookie), "lights have a direction");
    }
    for (const Camera& camera : scene.cameras) {
        require(finite(camera.eye) && finite(camera.target) && finite(camera.up), "cameras are finite");
    }
}

}  // namespace

void glb(Bytes file) {
    const auto scene = loadGlb(std::as_bytes(file), "fuzz", kLimits);
    if (scene) {
        requireSound(*scene);
    } else {
        require(!scene.error().message.empty() && scene.error().message.find('\n') == std::string::npos,
                "an error is one sentence");
    }
}

}  // namespace caustream::fuzz
