#include "scene/gltf_nodes.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace caustream::scene {

namespace {

constexpr int kMaxDepth = 256;
constexpr std::size_t kMaxNodes = 100'000;

tl::unexpected<LoadError> fail(std::string message) {
    return tl::unexpected(LoadError{std::move(message)});
}

glm::dmat4 localMatrix(const tinygltf::Node& node) {
    if (node.matrix.size() == 16) return glm::make_mat4(node.matrix.data());
    glm::dvec3 translation(0.0), scale(1.0);
    glm::dquat rotation(1.0, 0.0, 0.0, 0.0);
    if (node.translation.size() == 3) translation = glm::make_vec3(node.translation.data());
    if (node.scale.size() == 3) scale = glm::make_vec3(node.scale.data());
    if (node.rotation.size() == 4)
        rotation = glm::dquat(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    if (glm::length(rotation) > 0.0) rotation = glm::normalize(rotation);
    glm::dmat4 matrix = glm::mat4_cast(rotation);
    for (int k = 0; k < 3; ++k) matrix[k] *= scale[k];
    matrix[3] = glm::dvec4(translation, 1.0);
    return matrix;
}

bool finite(const glm::dmat4& m) {
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            if (!std::isfinite(m[c][r])) return false;
    return true;
}

tl::expected<std::vector<int>, LoadError> rootNodes(const tinygltf::Model& model) {
    if (!model.scenes.empty()) {
        const int chosen = model.defaultScene < 0 ? 0 : model.defaultScene;
        if (static_cast<std::size_t>(chosen) >= model.scenes.size())
            return fail("the file's scene " + std::to_string(chosen) + " is not there");
        return model.scenes[chosen].nodes;
    }
    std::vector<bool> isChild(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes)
        for (int child : node.children)
            if (child >= 0 && static_cast<std::size_t>(child) < isChild.size()) isChild[child] = true;
    std::vector<int> roots;
    for (std::size_t i = 0; i < isChild.size(); ++i)
        if (!isChild[i]) roots.push_back(static_cast<int>(i));
    return roots;
}

}  // namespace

tl::expected<std::vector<PlacedNode>, LoadError> placeNodes(const tinygltf::Model& model) {
    const auto roots = rootNodes(model);
    if (!roots) return tl::unexpected(roots.error());
    struct Pending {
        int node, depth;
        glm::dmat4 parent;
    };
    std::vector<Pending> pending;
    for (auto root = roots->rbegin(); root != roots->rend(); ++root) pending.push_back({*root, 0, glm::dmat4(1.0)});

    std::vector<PlacedNode> placed;
    std::vector<bool> reached(model.nodes.size(), false);
    while (!pending.empty()) {
        const Pending next = pending.back();
        pending.pop_back();
        const std::string what = "node " + std::to_string(next.node);
        if (next.node < 0 || static_cast<std::size_t>(next.node) >= model.nodes.size())
            return fail(what + " is not there");
        if (reached[next.node]) return fail(what + " has two parents or is its own ancestor");
        if (next.depth > kMaxDepth || placed.size() >= kMaxNodes) return fail("the file has too many nodes");
        reached[next.node] = true;
        const tinygltf::Node& node = model.nodes[next.node];
        const glm::dmat4 world = next.parent * localMatrix(node);
        if (!finite(world)) return fail(what + " has a transform with NaN or infinity");
        placed.push_back({next.node, world});
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
            pending.push_back({*child, next.depth + 1, world});
    }
    return placed;
}

}  // namespace caustream::scene
