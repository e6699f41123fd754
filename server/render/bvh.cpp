#include "render/bvh.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>
#include <new>

#include "error.h"
#include "scene/scene.h"

namespace caustream::render {

namespace {

constexpr unsigned kMostDepth = 96;     // nothing of ours is that deep; Embree gives up where many triangles share a centre
constexpr unsigned kMostInLeaf = 1u << Bvh::kLeafBits;
constexpr float kIntersectionCost = 0.5f;   // of a triangle, in boxes: fewer nodes are worth more triangles (docs/pipeline.md)
constexpr float kCells = 65533.0f;      // of 2^16, less the one that boxes are wider by at either side

struct Node {
    std::array<scene::Bounds, 2> boxes{};   // the children's: Embree tells them before the children
    std::array<Node*, 2> children{};        // null: a leaf
    std::array<std::uint32_t, 1u << Bvh::kLeafBits> triangles{};
    std::uint32_t count = 0;
};

template <auto Release>
struct Releaser {
    template <class T>
    void operator()(T* pointer) const {
        Release(pointer);
    }
};

scene::Bounds boundsOf(const RTCBounds& b) {
    return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}

void* createNode(RTCThreadLocalAllocator allocator, unsigned, void*) {
    return new (rtcThreadLocalAlloc(allocator, sizeof(Node), alignof(Node))) Node;
}

void setChildren(void* node, void** children, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) static_cast<Node*>(node)->children[i] = static_cast<Node*>(children[i]);
}

void setBounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) static_cast<Node*>(node)->boxes[i] = boundsOf(*bounds[i]);
}

void* createLeaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count, void*) {
    Node* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(Node), alignof(Node))) Node;
    leaf->count = static_cast<std::uint32_t>(count);
    for (std::size_t i = 0; i < count; ++i) leaf->triangles[i] = primitives[i].primID;
    return leaf;
}

// What light can meet.
std::vector<RTCBuildPrimitive> primitivesOf(std::span<const Triangle> triangles) {
    std::vector<RTCBuildPrimitive> primitives;
    primitives.reserve(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const auto& [a, b, c] = triangles[i].corners;
        const double area = glm::length(glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a)));
        if (!(area > 0.0) || !std::isfinite(area)) continue;
        const glm::vec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
        primitives.push_back({low.x, low.y, low.z, 0, high.x, high.y, high.z, static_cast<unsigned>(i)});
    }
    return primitives;
}

class Flattening {
 public:
    Flattening(Bvh& bvh, const Node& root, const scene::Bounds& box) : bvh_(bvh) {
        const glm::vec3 extent = box.max - box.min;
        const float least = std::max(1e-3f * std::max({extent.x, extent.y, extent.z}), 1e-30f);
        bvh.low = box.min;
        bvh.cellsPerM = kCells / glm::max(extent, glm::vec3(least));
        walk(root, box);
    }

 private:
    // Outwards by a cell, which is more than what is rounded away when rays are set against boxes.
    glm::uvec4 boxed(const scene::Bounds& box) const {
        glm::uvec4 node(0);
        for (int k = 0; k < 3; ++k) {
            const float low = std::floor((box.min[k] - bvh_.low[k]) * bvh_.cellsPerM[k]);
            const float high = std::ceil((box.max[k] - bvh_.low[k]) * bvh_.cellsPerM[k]) + 2.0f;
            node[k] = static_cast<std::uint32_t>(std::clamp(low, 0.0f, 65535.0f)) |
                      static_cast<std::uint32_t>(std::clamp(high, 0.0f, 65535.0f)) << 16;
        }
        return node;
    }

    void walk(const Node& node, const scene::Bounds& box) {
        const std::size_t at = bvh_.nodes.size();
        bvh_.nodes.push_back(boxed(box));
        if (!node.children[0]) {
            const auto place = static_cast<std::uint32_t>(bvh_.triangles.size());
            bvh_.triangles.insert(bvh_.triangles.end(), node.triangles.begin(), node.triangles.begin() + node.count);
            bvh_.nodes[at].w = Bvh::kLeaf | place << Bvh::kLeafBits | (node.count - 1);
            return;
        }
        walk(*node.children[0], node.boxes[0]);
        walk(*node.children[1], node.boxes[1]);
        bvh_.nodes[at].w = static_cast<std::uint32_t>(bvh_.nodes.size());
    }

    Bvh& bvh_;
};

}  // namespace

Bvh buildBvh(std::span<const Triangle> triangles) {
    Bvh bvh;
    std::vector<RTCBuildPrimitive> primitives = primitivesOf(triangles);
    if (primitives.empty()) return bvh;
    scene::Bounds all;
    for (const RTCBuildPrimitive& p : primitives) {
        all.add({{p.lower_x, p.lower_y, p.lower_z}, {p.upper_x, p.upper_y, p.upper_z}});
    }

    const std::unique_ptr<RTCDeviceTy, Releaser<rtcReleaseDevice>> device(rtcNewDevice("threads=1"));
    if (!device) throw Error("Embree does not start; install libembree3-3 for this processor");
    const std::unique_ptr<RTCBVHTy, Releaser<rtcReleaseBVH>> tree(rtcNewBVH(device.get()));
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.maxDepth = kMostDepth;
    arguments.maxLeafSize = kMostInLeaf;
    arguments.intersectionCost = kIntersectionCost;
    arguments.bvh = tree.get();
    arguments.primitives = primitives.data();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = createNode;
    arguments.setNodeChildren = setChildren;
    arguments.setNodeBounds = setBounds;
    arguments.createLeaf = createLeaf;
    auto* root = static_cast<Node*>(rtcBuildBVH(&arguments));
    if (!root) throw Error("Embree builds no hierarchy over " + std::to_string(primitives.size()) + " triangles");
    Flattening(bvh, *root, all);
    return bvh;
}

}  // namespace caustream::render
