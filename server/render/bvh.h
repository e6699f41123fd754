// A hierarchy of boxes over triangles, for shaders that have no stack: nodes in the order of a walk, each with where to
// go on when its box is missed. Eight orders, one for each octant that rays may go to, so that near boxes come first.
#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

namespace caustream::render {

struct Triangle {
    std::array<glm::vec3, 3> corners;
};

struct Bvh {
    static constexpr int kLeafBits = 3;              // most triangles of a leaf: 8
    static constexpr std::uint32_t kLeaf = 0x80000000u;

    // xyz: the box, low sides in the low 16 bits, high sides in the high ones, in cells of the grid below. w: the node to
    // go on with when the box is missed; or kLeaf | first << kLeafBits | count - 1, triangles in the order of `triangles`
    // (then the next node is where to go on).
    std::vector<glm::uvec4> nodes;
    std::vector<std::uint32_t> triangles;            // the leaves' triangles: numbers of those given
    glm::vec3 low{0.0f}, cellsPerM{1.0f};            // cell = 1 + (position - low) * cellsPerM
};

// Binned surface area heuristic (Embree's builder, one thread, so that equal input gives equal output). Triangles that
// are not finite or have no area are left out; without any there are no nodes. Throws Error when Embree does not start.
Bvh buildBvh(std::span<const Triangle> triangles);

}  // namespace caustream::render
