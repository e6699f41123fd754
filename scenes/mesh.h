// A triangle mesh while it is being made. Metres, counter-clockwise seen from outside.
#pragma once
#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace caustream::scenes {

struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;  // empty: flat, as glTF says
    std::vector<glm::vec2> uvs;      // empty: none
    std::vector<std::uint32_t> indices;
};

// Normals as the mean of the faces around each vertex, weighted by their angle there (Thuermer & Wuethrich 1998).
void smoothNormals(Mesh& mesh);

void append(Mesh& mesh, const Mesh& other);
void transform(Mesh& mesh, const glm::mat4& matrix);

// Moves it up or down until its lowest point is at `y`.
void standAt(Mesh& mesh, double y);

// Unit icosahedron subdivided `levels` times: 20 * 4^levels faces. Vertices on the sphere, smooth normals.
Mesh icosphere(int levels, const glm::dvec3& centre, double radius);

// Around the y axis, `around` x `across` quads. Smooth normals.
Mesh torus(double majorRadius, double minorRadius, int around, int across);

// (radius, height) points of a smooth curve.
using Profile = std::vector<glm::dvec2>;
// Goes on from the profile's last point in `segments` steps: straight to `b`, along a quadratic Bezier arc.
void lineTo(Profile& curve, const glm::dvec2& b, int segments);
void bendTo(Profile& curve, const glm::dvec2& control, const glm::dvec2& b, int segments);
// Turns curves around the y axis, `around` steps: normals are smooth along each curve, with an edge where one ends and
// the next begins. From the axis at the bottom, outside, to the axis at the top: closed and outside out.
Mesh lathe(const std::vector<Profile>& curves, int around);

// Corners counter-clockwise seen from the side the normal points to; uv 0..1 with v down.
Mesh quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d);
Mesh box(const glm::vec3& min, const glm::vec3& max);

// The solid n . x <= d of all planes (x, y, z of each: unit outward normal; w: d), flat faces with unshared corners.
// A plane that cuts nothing off has no face. The solid must be bounded.
Mesh convexPolyhedron(std::span<const glm::dvec4> planes);

// Volume inside the surface by the divergence theorem, m^3; negative when it is inside out.
double signedVolume(const Mesh& mesh);

}  // namespace caustream::scenes
