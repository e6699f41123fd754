// From triangles as a file gives them to triangles that light can be traced through.
#pragma once
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "scene/primitive_reader.h"
#include "scene/scene.h"

namespace caustream::scene {

struct Part {  // of one object; indices into its own vertices
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
};

// Appends `soup`, moved by `world`, to `part`: a mirror keeps counter-clockwise outside, triangles without area are
// left out (their number is returned), vertices without a usable normal get their triangle's. False in `isNear` when a
// position lies beyond 1e8 m: a light and a camera placed around it still have coordinates that a state document may hold.
std::size_t bake(const TriangleSoup& soup, const glm::dmat4& world, Part& part, bool& isNear);

struct Topology {
    bool closed = false;           // every edge has exactly one partner that runs the other way
    std::size_t openEdges = 0;     // edges without a partner
    std::size_t crowdedEdges = 0;  // edges of more than two triangles
    double volume = 0.0;           // m^3, signed; meaningful when closed
};

// Joins vertices at the same position first, so that seams of normals or uv do not count.
Topology examine(const Part& part);

// Leaves out triangles that have the same three corners as an earlier one, in the same order; returns how many.
std::size_t dropDuplicates(Part& part);

// Turns every triangle and normal around.
void turnInsideOut(Part& part);

}  // namespace caustream::scene
