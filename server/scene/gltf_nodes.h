// The node tree of a glTF scene, flattened.
#pragma once
#include <tiny_gltf.h>
#include <glm/mat4x4.hpp>
#include <tl/expected.hpp>
#include <vector>

#include "scene/gltf_loader.h"

namespace caustream::scene {

struct PlacedNode {
    int index = 0;  // into Model::nodes
    glm::dmat4 world{1.0};
};

// Every node of the default scene (of the whole file where it has no scene), parents before children. An error names a
// node that is not there, has two parents, is its own ancestor, or has no finite transform.
tl::expected<std::vector<PlacedNode>, LoadError> placeNodes(const tinygltf::Model& model);

}  // namespace caustream::scene
