// One glTF primitive -> a triangle list in its node's space.
#pragma once
#include <tiny_gltf.h>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "scene/gltf_materials.h"

namespace caustream::scene {

struct TriangleSoup {
    std::vector<glm::dvec3> positions;   // finite
    std::vector<glm::dvec3> normals;     // empty, or one a position; any length, perhaps zero
    std::vector<glm::dvec2> uvs;         // empty, or one a position
    std::vector<std::uint32_t> indices;  // three a triangle, each inside positions
};

// Strips and fans become lists; points and lines give no triangles. `budget` is what may still be read: vertices and
// indices together; it is charged. Errors name the accessor.
tl::expected<TriangleSoup, LoadError> readPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                                    const UvSource& uv, std::size_t& budget, const std::string& what);

}  // namespace caustream::scene
