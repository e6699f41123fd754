#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "scenes/mesh.h"

namespace caustream::scenes {

namespace {

constexpr double kOnPlane = 1e-9;  // relative to the solid's size of about one

// The corners of one face: where it meets two other planes and no plane cuts the point off.
std::vector<glm::dvec3> corners(std::span<const glm::dvec4> planes, std::size_t face) {
    std::vector<glm::dvec3> points;
    for (std::size_t i = 0; i < planes.size(); ++i)
        for (std::size_t j = i + 1; j < planes.size(); ++j) {
            if (i == face || j == face) continue;
            const glm::dmat3 rows =
                glm::transpose(glm::dmat3(glm::dvec3(planes[face]), glm::dvec3(planes[i]), glm::dvec3(planes[j])));
            if (std::abs(glm::determinant(rows)) < 1e-9) continue;
            const glm::dvec3 point = glm::inverse(rows) * glm::dvec3(planes[face].w, planes[i].w, planes[j].w);
            const bool inside = std::all_of(planes.begin(), planes.end(), [&](const glm::dvec4& p) {
                return glm::dot(glm::dvec3(p), point) <= p.w + kOnPlane;
            });
            const bool isNew = std::none_of(points.begin(), points.end(), [&](const glm::dvec3& other) {
                return glm::distance(other, point) < 10.0 * kOnPlane;
            });
            if (inside && isNew) points.push_back(point);
        }
    return points;
}

}  // namespace

Mesh convexPolyhedron(std::span<const glm::dvec4> planes) {
    Mesh mesh;
    for (std::size_t face = 0; face < planes.size(); ++face) {
        std::vector<glm::dvec3> points = corners(planes, face);
        if (points.size() < 3) continue;

        // Counter-clockwise around the face's middle, seen from outside.
        const glm::dvec3 normal(planes[face]);
        glm::dvec3 middle(0.0);
        for (const glm::dvec3& p : points) middle += p / static_cast<double>(points.size());
        const glm::dvec3 u = glm::normalize(points[0] - middle), v = glm::cross(normal, u);
        std::sort(points.begin(), points.end(), [&](const glm::dvec3& a, const glm::dvec3& b) {
            const glm::dvec3 da = a - middle, db = b - middle;
            return std::atan2(glm::dot(da, v), glm::dot(da, u)) < std::atan2(glm::dot(db, v), glm::dot(db, u));
        });

        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const glm::dvec3& p : points) {
            mesh.positions.push_back(glm::vec3(p));
            mesh.normals.push_back(glm::vec3(normal));
        }
        for (std::uint32_t i = 1; i + 1 < points.size(); ++i)
            mesh.indices.insert(mesh.indices.end(), {first, first + i, first + i + 1});
    }
    return mesh;
}

}  // namespace caustream::scenes
