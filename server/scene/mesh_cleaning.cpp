#include "scene/mesh_cleaning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numeric>
#include <tuple>
#include <utility>

namespace caustream::scene {

namespace {

constexpr float kFarM = 1e8f;

bool within(const glm::vec3& v) {
    return std::abs(v.x) <= kFarM && std::abs(v.y) <= kFarM && std::abs(v.z) <= kFarM;
}

glm::vec2 usableUv(const glm::dvec2& uv) {
    const glm::vec2 rounded(uv);
    return std::isfinite(rounded.x) && std::isfinite(rounded.y) ? rounded : glm::vec2(0.0f);
}

// Inverse transpose times the determinant's square: the direction of normals under `m`, also when m has no inverse.
glm::dmat3 normalMatrix(const glm::dmat3& m) {
    const glm::dmat3 cofactor(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    return glm::determinant(m) < 0.0 ? -cofactor : cofactor;
}

glm::dvec3 unitOrZero(const glm::dvec3& v) {
    const double length = glm::length(v);
    return std::isfinite(length) && length > 0.0 ? v / length : glm::dvec3(0.0);
}

bool before(const glm::vec3& a, const glm::vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

// One number for each distinct position. By sorting, here and below: a hash table of millions of entries takes several
// times the memory and the time.
std::vector<std::uint32_t> weld(const Part& part) {
    const std::vector<Vertex>& vertices = part.vertices;
    std::vector<std::uint32_t> order(vertices.size()), welded(vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return before(vertices[a].position, vertices[b].position); });
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i > 0 && vertices[order[i]].position != vertices[order[i - 1]].position) ++number;
        welded[order[i]] = number;
    }
    return welded;
}

std::uint64_t edgeKey(std::uint32_t a, std::uint32_t b) {
    return static_cast<std::uint64_t>(a) << 32 | b;
}

}  // namespace

std::size_t bake(const TriangleSoup& soup, const glm::dmat4& world, Part& part, bool& isNear) {
    const glm::dmat3 linear(world);
    const glm::dmat3 normals = normalMatrix(linear);
    const bool mirrored = glm::determinant(linear) < 0.0;
    std::vector<glm::vec3> positions(soup.positions.size());
    isNear = true;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        positions[i] = glm::vec3(world * glm::dvec4(soup.positions[i], 1.0));
        isNear = isNear && within(positions[i]);
    }
    if (!isNear) return 0;

    constexpr std::uint32_t kNone = ~0u;
    std::vector<std::uint32_t> shared(soup.positions.size(),
                                      kNone);  // file's vertex -> part's, where a normal is given
    std::size_t dropped = 0;
    for (std::size_t t = 0; t < soup.indices.size(); t += 3) {
        std::array<std::uint32_t, 3> corner{soup.indices[t], soup.indices[t + 1], soup.indices[t + 2]};
        if (mirrored) std::swap(corner[1], corner[2]);
        const glm::dvec3 a = positions[corner[0]], b = positions[corner[1]], c = positions[corner[2]];
        const glm::dvec3 flat = unitOrZero(glm::cross(b - a, c - a));
        if (flat == glm::dvec3(0.0)) {
            ++dropped;
            continue;
        }
        for (std::uint32_t i : corner) {
            if (shared[i] != kNone) {
                part.indices.push_back(shared[i]);
                continue;
            }
            const glm::dvec3 given = soup.normals.empty() ? glm::dvec3(0.0) : unitOrZero(normals * soup.normals[i]);
            const bool usable = given != glm::dvec3(0.0);
            const auto index = static_cast<std::uint32_t>(part.vertices.size());
            if (usable) shared[i] = index;
            part.vertices.push_back({positions[i], glm::vec3(usable ? given : flat),
                                     soup.uvs.empty() ? glm::vec2(0.0f) : usableUv(soup.uvs[i])});
            part.indices.push_back(index);
        }
    }
    return dropped;
}

Topology examine(const Part& part) {
    const std::vector<std::uint32_t> welded = weld(part);
    std::vector<std::uint64_t> edges;
    edges.reserve(part.indices.size());
    Topology topology;
    // Around one of its own points, so that a small mesh far from the origin keeps its digits.
    const glm::dvec3 origin = part.vertices.empty() ? glm::dvec3(0.0) : glm::dvec3(part.vertices[0].position);
    for (std::size_t t = 0; t < part.indices.size(); t += 3) {
        glm::dvec3 p[3];
        for (int k = 0; k < 3; ++k) {
            p[k] = glm::dvec3(part.vertices[part.indices[t + k]].position) - origin;
            edges.push_back(edgeKey(welded[part.indices[t + k]], welded[part.indices[t + (k + 1) % 3]]));
        }
        topology.volume += glm::dot(p[0], glm::cross(p[1], p[2])) / 6.0;
    }
    std::sort(edges.begin(), edges.end());
    bool paired = !edges.empty();
    for (auto edge = edges.begin(); edge != edges.end();) {
        const auto next = std::upper_bound(edge, edges.end(), *edge);
        const auto partners = std::equal_range(edges.begin(), edges.end(), *edge << 32 | *edge >> 32);
        const auto count = next - edge, back = partners.second - partners.first;
        paired = paired && back == count;
        if (back == 0) topology.openEdges += static_cast<std::size_t>(count);
        if (count + back > 2) ++topology.crowdedEdges;
        edge = next;
    }
    topology.closed = paired;
    return topology;
}

std::size_t dropDuplicates(Part& part) {
    using Corners = std::array<std::uint32_t, 3>;
    const std::vector<std::uint32_t> welded = weld(part);
    std::vector<std::pair<Corners, std::uint32_t>> faces;  // and where its indices begin
    faces.reserve(part.indices.size() / 3);
    for (std::size_t t = 0; t < part.indices.size(); t += 3) {
        Corners face;
        for (int k = 0; k < 3; ++k) face[k] = welded[part.indices[t + k]];
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
        faces.emplace_back(face, static_cast<std::uint32_t>(t));
    }
    std::sort(faces.begin(), faces.end());
    std::vector<bool> again(part.indices.size() / 3, false);
    for (std::size_t i = 1; i < faces.size(); ++i) again[faces[i].second / 3] = faces[i].first == faces[i - 1].first;
    std::vector<std::uint32_t> kept;
    kept.reserve(part.indices.size());
    for (std::size_t t = 0; t < part.indices.size(); t += 3)
        if (!again[t / 3])
            kept.insert(kept.end(), part.indices.begin() + static_cast<std::ptrdiff_t>(t),
                        part.indices.begin() + static_cast<std::ptrdiff_t>(t + 3));
    const std::size_t dropped = (part.indices.size() - kept.size()) / 3;
    part.indices = std::move(kept);
    return dropped;
}

void turnInsideOut(Part& part) {
    for (Vertex& vertex : part.vertices) vertex.normal = -vertex.normal;
    for (std::size_t t = 0; t < part.indices.size(); t += 3) std::swap(part.indices[t + 1], part.indices[t + 2]);
}

}  // namespace caustream::scene
