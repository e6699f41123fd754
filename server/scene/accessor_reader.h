// Accessors -> vectors, every byte checked before it is read.
#pragma once
#include <tiny_gltf.h>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "scene/gltf_loader.h"

namespace caustream::scene {

// Reads the accessor as `components` numbers an element, normalised integers as glTF 2.0, section 3.6.2.2 says; sparse
// ones too. At most `maxCount` elements. Errors name the accessor and `what`.
tl::expected<std::vector<double>, LoadError> readAccessor(const tinygltf::Model& model, int accessor, int components,
                                                          std::size_t maxCount, const std::string& what);

tl::expected<std::vector<glm::dvec3>, LoadError> readVec3(const tinygltf::Model& model, int accessor,
                                                          std::size_t maxCount, const std::string& what);
tl::expected<std::vector<glm::dvec2>, LoadError> readVec2(const tinygltf::Model& model, int accessor,
                                                          std::size_t maxCount, const std::string& what);
// Unsigned integers of 8, 16 or 32 bits.
tl::expected<std::vector<std::uint32_t>, LoadError> readIndices(const tinygltf::Model& model, int accessor,
                                                                std::size_t maxCount);

}  // namespace caustream::scene
