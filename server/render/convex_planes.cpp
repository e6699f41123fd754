#include "render/convex_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>
#include <unordered_map>

namespace caustream::render {

namespace {

constexpr double kFlatCosine = 0.99985;      // one degree: normals packed into bytes are half a degree off
constexpr double kOfSize = 1e-5;             // faces that bend less are one: a hundredth of a map's texel
constexpr double kRoundings = 4.0;           // of the largest coordinate
constexpr double kSliverHeight = 20.0;       // tolerances; flatter triangles have no direction of their own

struct Face {
    std::array<std::uint32_t, 3> corner;     // points of the mesh
    std::array<std::uint32_t, 3> vertex;     // of the scene
    glm::dvec3 area{0.0};                    // normal times twice the area
    double area2 = 0.0, height = 0.0;        // m^2, m
};

struct Mesh {
    std::vector<glm::dvec3> points;          // around the middle of the object
    std::vector<Face> faces;                 // largest first
    glm::dvec3 middle{0.0};
    double tolerance = 0.0;                  // m
};

// Points nearer than `tolerance` become one, so that seams and rounding do not count: the number of each.
std::vector<std::uint32_t> weld(const std::vector<glm::dvec3>& points, double tolerance) {
    const double cell = 2.0 * tolerance;
    const auto key = [](const glm::dvec3& at) {
        std::uint64_t h = 0;
        for (int k = 0; k < 3; ++k) {
            h = (h ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(at[k])))) * 0x9E3779B97F4A7C15u;
        }
        return h ^ h >> 32;
    };
    std::unordered_multimap<std::uint64_t, std::uint32_t> cells;   // first points alone
    cells.reserve(points.size());
    std::vector<std::uint32_t> welded(points.size());
    for (std::uint32_t i = 0; i < welded.size(); ++i) {
        welded[i] = i;
        for (int side = 0; side < 8 && welded[i] == i; ++side) {   // the cells within reach
            const glm::dvec3 reach(side & 1 ? 0.5 : -0.5, side & 2 ? 0.5 : -0.5, side & 4 ? 0.5 : -0.5);
            const auto [first, last] = cells.equal_range(key(points[i] / cell + reach));
            for (auto entry = first; entry != last; ++entry) {
                if (glm::distance(points[entry->second], points[i]) <= tolerance) welded[i] = entry->second;
            }
        }
        if (welded[i] == i) cells.emplace(key(points[i] / cell), i);
    }
    return welded;
}

Mesh meshOf(const scene::Geometry& geometry, const scene::Object& object) {
    Mesh mesh;
    mesh.middle = glm::dvec3(object.bounds.centre());
    const glm::dvec3 far = glm::max(glm::abs(glm::dvec3(object.bounds.min)), glm::abs(glm::dvec3(object.bounds.max)));
    const double rounding = std::max({far.x, far.y, far.z}) * static_cast<double>(std::numeric_limits<float>::epsilon());
    mesh.tolerance = std::max(kOfSize * static_cast<double>(object.bounds.radius()), kRoundings * rounding);

    std::unordered_map<std::uint32_t, std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < object.indexCount; ++i) {
        const std::uint32_t vertex = geometry.indices[object.firstIndex + i];
        if (numbers.try_emplace(vertex, static_cast<std::uint32_t>(mesh.points.size())).second)
            mesh.points.push_back(glm::dvec3(geometry.vertices[vertex].position) - mesh.middle);
    }
    for (std::uint32_t i = 0; i + 2 < object.indexCount; i += 3) {
        Face face;
        for (std::uint32_t k = 0; k < 3; ++k) {
            face.vertex[k] = geometry.indices[object.firstIndex + i + k];
            face.corner[k] = numbers[face.vertex[k]];
        }
        const glm::dvec3 a = mesh.points[face.corner[0]], ab = mesh.points[face.corner[1]] - a, ac = mesh.points[face.corner[2]] - a;
        face.area = glm::cross(ab, ac);
        face.area2 = glm::length(face.area);
        const double longest = std::max({glm::length(ab), glm::length(ac), glm::length(ac - ab)});
        if (!(longest > 0.0)) continue;
        face.height = face.area2 / longest;
        mesh.faces.push_back(face);
    }
    std::stable_sort(mesh.faces.begin(), mesh.faces.end(), [](const Face& a, const Face& b) { return a.area2 > b.area2; });
    return mesh;
}

bool closed(const Mesh& mesh) {
    const std::vector<std::uint32_t> welded = weld(mesh.points, 0.1 * mesh.tolerance);
    std::unordered_map<std::uint64_t, int> edges;   // bits: used one way, used the other way
    edges.reserve(mesh.faces.size() * 3);
    for (const Face& face : mesh.faces) {
        std::array<std::uint64_t, 3> corner{};
        for (std::size_t k = 0; k < 3; ++k) corner[k] = welded[face.corner[k]];
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint64_t a = corner[k], b = corner[(k + 1) % 3];
            int& uses = edges[a < b ? a << 32 | b : b << 32 | a];
            const int way = a < b ? 1 : 2;
            if (uses & way) return false;
            uses |= way;
        }
    }
    return std::all_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second == 3; });
}

struct Planes {
    std::vector<glm::dvec4> planes;          // around Mesh::middle
    std::vector<int> ofFace;
};

// Large faces found planes, others join the one that all their corners lie on. More than kMostPlanes: given up.
Planes merge(const Mesh& mesh) {
    Planes merged;
    for (const Face& face : mesh.faces) {
        const bool sliver = face.height < kSliverHeight * mesh.tolerance;
        const glm::dvec3 normal = face.area2 > 0.0 ? face.area / face.area2 : glm::dvec3(0.0);
        int found = -1;
        for (std::size_t i = 0; i < merged.planes.size() && found < 0; ++i) {
            const glm::dvec3 outward(merged.planes[i]);
            const bool on = std::all_of(face.corner.begin(), face.corner.end(), [&](std::uint32_t p) {
                return std::abs(glm::dot(outward, mesh.points[p]) - merged.planes[i].w) <= mesh.tolerance;
            });
            if (on && (sliver || glm::dot(outward, normal) > 0.9)) found = static_cast<int>(i);
        }
        if (found < 0) {
            found = static_cast<int>(merged.planes.size());
            if (found == kMostPlanes || face.area2 == 0.0) return {};
            merged.planes.emplace_back(normal, glm::dot(normal, mesh.points[face.corner[0]]));
        }
        merged.ofFace.push_back(found);
    }
    // All of a face's triangles together know its plane best.
    std::vector<glm::dvec4> sums(merged.planes.size(), glm::dvec4(0.0));
    std::vector<double> offsets(merged.planes.size(), 0.0);
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
        sums[static_cast<std::size_t>(merged.ofFace[i])] += glm::dvec4(mesh.faces[i].area, mesh.faces[i].area2);
    }
    for (std::size_t i = 0; i < sums.size(); ++i) merged.planes[i] = glm::dvec4(glm::normalize(glm::dvec3(sums[i])), 0.0);
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
        const auto plane = static_cast<std::size_t>(merged.ofFace[i]);
        for (const std::uint32_t p : mesh.faces[i].corner) {
            offsets[plane] += mesh.faces[i].area2 / 3.0 * glm::dot(glm::dvec3(merged.planes[plane]), mesh.points[p]);
        }
    }
    for (std::size_t i = 0; i < sums.size(); ++i) merged.planes[i].w = offsets[i] / sums[i].w;
    return merged;
}

bool flatShaded(const scene::Geometry& geometry, const Mesh& mesh, const Planes& planes) {
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
        if (mesh.faces[i].height < kSliverHeight * mesh.tolerance) continue;
        const glm::dvec3 outward(planes.planes[static_cast<std::size_t>(planes.ofFace[i])]);
        for (const std::uint32_t vertex : mesh.faces[i].vertex) {
            const glm::dvec3 normal(geometry.vertices[vertex].normal);
            if (!(glm::dot(outward, normal) >= kFlatCosine * glm::length(normal))) return false;
        }
    }
    return true;
}

}  // namespace

ConvexShape findConvexShape(const scene::Geometry& geometry, const scene::Object& object) {
    const std::string triangles = std::to_string(object.indexCount / 3) + " triangles, ";
    const auto mesh = meshOf(geometry, object);
    if (mesh.faces.size() < 4) return {{}, triangles + "not a solid"};
    Planes planes = merge(mesh);
    if (planes.planes.empty()) return {{}, triangles + "more than " + std::to_string(kMostPlanes) + " flat faces"};
    for (const glm::dvec4& plane : planes.planes) {
        for (const glm::dvec3& point : mesh.points) {
            if (!(glm::dot(glm::dvec3(plane), point) <= plane.w + 2.0 * mesh.tolerance)) return {{}, triangles + "not convex"};
        }
    }
    if (!closed(mesh)) return {{}, triangles + "not closed"};
    if (!flatShaded(geometry, mesh, planes)) return {{}, triangles + "shaded with interpolated normals"};
    for (glm::dvec4& plane : planes.planes) plane.w += glm::dot(glm::dvec3(plane), mesh.middle);
    const std::string why = std::to_string(planes.planes.size()) + " planes, closed and convex";
    return {std::move(planes.planes), why};
}

std::shared_ptr<const ConvexShape> convexShape(const std::shared_ptr<const scene::Geometry>& geometry, std::size_t object) {
    using Shapes = std::map<std::size_t, std::shared_ptr<const ConvexShape>>;
    static std::mutex mutex;
    static std::map<std::weak_ptr<const scene::Geometry>, Shapes, std::owner_less<>> known;   // guarded by mutex
    const std::lock_guard lock(mutex);
    std::erase_if(known, [](const auto& entry) { return entry.first.expired(); });
    std::shared_ptr<const ConvexShape>& shape = known[geometry][object];
    if (!shape) shape = std::make_shared<ConvexShape>(findConvexShape(*geometry, geometry->objects[object]));
    return shape;
}

}  // namespace caustream::render
