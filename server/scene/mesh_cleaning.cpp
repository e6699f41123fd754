#include "scene/mesh_cleaning.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <unordered_map>
#include <unordered_set>

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

struct PositionHash {
    std::size_t operator()(const glm::vec3& p) const {
        std::size_t h = 0;
        for (int k = 0; k < 3; ++k) h = (h ^ std::bit_cast<std::uint32_t>(p[k] + 0.0f)) * 0x9E3779B97F4A7C15u;
        return h ^ h >> 32;
    }
};

// One number for each distinct position.
std::vector<std::uint32_t> weld(const Part& part) {
    std::unordered_map<glm::vec3, std::uint32_t, PositionHash> numbers;
    numbers.reserve(part.vertices.size());
    std::vector<std::uint32_t> welded(part.vertices.size());
    for (std::size_t i = 0; i < welded.size(); ++i)
        welded[i] =
            numbers.try_emplace(part.vertices[i].position, static_cast<std::uint32_t>(numbers.size())).first->second;
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
    std::unordered_map<std::uint64_t, std::uint32_t> edges;
    edges.reserve(part.indices.size());
    Topology topology;
    // Around one of its own points, so that a small mesh far from the origin keeps its digits.
    const glm::dvec3 origin = part.vertices.empty() ? glm::dvec3(0.0) : glm::dvec3(part.vertices[0].position);
    for (std::size_t t = 0; t < part.indices.size(); t += 3) {
        glm::dvec3 p[3];
        for (int k = 0; k < 3; ++k) {
            p[k] = glm::dvec3(part.vertices[part.indices[t + k]].position) - origin;
            ++edges[edgeKey(welded[part.indices[t + k]], welded[part.indices[t + (k + 1) % 3]])];
        }
        topology.volume += glm::dot(p[0], glm::cross(p[1], p[2])) / 6.0;
    }
    bool paired = !edges.empty();
    for (const auto& [key, count] : edges) {
        const auto partner = edges.find(key << 32 | key >> 32);
        const std::uint32_t back = partner == edges.end() ? 0 : partner->second;
        paired = paired && back == count;
        if (back == 0) topology.openEdges += count;
        if (count + back > 2) ++topology.crowdedEdges;
    }
    topology.closed = paired;
    return topology;
}

std::size_t dropDuplicates(Part& part) {
    struct FaceHash {
        std::size_t operator()(const std::array<std::uint32_t, 3>& f) const {
            return (f[0] * 0x9E3779B97F4A7C15u ^ f[1]) * 0x9E3779B97F4A7C15u ^ f[2];
        }
    };
    const std::vector<std::uint32_t> welded = weld(part);
    std::unordered_set<std::array<std::uint32_t, 3>, FaceHash> seen;
    std::vector<std::uint32_t> kept;
    kept.reserve(part.indices.size());
    for (std::size_t t = 0; t < part.indices.size(); t += 3) {
        std::array<std::uint32_t, 3> face;
        for (int k = 0; k < 3; ++k) face[k] = welded[part.indices[t + k]];
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
        if (seen.insert(face).second)
            kept.insert(kept.end(), part.indices.begin() + static_cast<std::ptrdiff_t>(t),
                        part.indices.begin() + static_cast<std::ptrdiff_t>(t + 3));
    }
    const std::size_t dropped = (part.indices.size() - kept.size()) / 3;
    part.indices = std::move(kept);
    return dropped;
}

void turnInsideOut(Part& part) {
    for (Vertex& vertex : part.vertices) vertex.normal = -vertex.normal;
    for (std::size_t t = 0; t < part.indices.size(); t += 3) std::swap(part.indices[t + 1], part.indices[t + 2]);
}

}  // namespace caustream::scene
