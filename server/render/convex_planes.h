// Which objects are convex solids of few flat faces: rays meet those as a set of planes, without any triangle.
#pragma once
#include <glm/vec4.hpp>
#include <memory>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace caustream::render {

inline constexpr int kMostPlanes = 128;

struct ConvexShape {
    std::vector<glm::dvec4> planes;  // the points with dot(xyz, p) <= w for all of them; unit, outwards; empty: not such a solid
    std::string why;                 // a part of a sentence, either way
    bool convex() const { return !planes.empty(); }
};

// Looks at triangles and vertex normals alone: closed, every vertex behind every plane within rounding (1e-5 of the
// object's size, or a few roundings of its coordinates), shaded flat within a degree, as light refracts at the
// interpolated normal. Triangles of one face may be any number, and slivers.
ConvexShape findConvexShape(const scene::Geometry& geometry, const scene::Object& object);

// The same, kept for as long as `geometry` lives. Any thread.
std::shared_ptr<const ConvexShape> convexShape(const std::shared_ptr<const scene::Geometry>& geometry, std::size_t object);

}  // namespace caustream::render
