// Writes a binary glTF 2.0 file: meshes, materials, lights and cameras in world space, one node each.
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "scenes/mesh.h"

namespace caustream::scenes {

class GlbWriter {
 public:
    GlbWriter();

    // `material` is glTF's JSON for a material; `image` a PNG file. Both return an index.
    int addMaterial(nlohmann::json material);
    int addTexture(std::span<const std::uint8_t> png);

    void addMesh(const std::string& name, const Mesh& mesh, int material);

    // `light` is KHR_lights_punctual's JSON for a light, aimed from `position` at `target` (-Z of its node).
    void addLight(nlohmann::json light, const glm::dvec3& position, const glm::dvec3& target);
    void addCamera(const std::string& name, const glm::dvec3& eye, const glm::dvec3& target, double fovYDeg);

    // extras.caustream of the scene.
    void setSceneExtras(nlohmann::json extras);

    // The finished file. The writer may be added to and asked again.
    std::vector<std::uint8_t> finish() const;

 private:
    int addView(const void* data, std::size_t bytes);
    int addAccessor(const void* data, std::size_t count, std::size_t stride, int componentType, const char* type);
    void addNode(nlohmann::json node);
    void use(const std::string& extension);

    nlohmann::json json_;
    std::vector<std::uint8_t> binary_;
};

// A material that light goes through: a caster. `extras` is extras.caustream (docs/units.md): cauchy, absorption...
nlohmann::json glassMaterial(const std::string& name, double ior, nlohmann::json extras);
nlohmann::json matteMaterial(const std::string& name, const glm::vec3& color);
// Polished: a mirror (docs/units.md).
nlohmann::json metalMaterial(const std::string& name, const glm::vec3& color);
// Half angles in degrees, intensity in candela.
nlohmann::json spotLight(const std::string& name, double candela, double innerDeg, double outerDeg);

}  // namespace caustream::scenes
