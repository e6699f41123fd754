#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <numbers>
#include <utility>

#include "scenes/mesh.h"

namespace caustream::scenes {

void smoothNormals(Mesh& mesh) {
    std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        glm::dvec3 p[3];
        for (int k = 0; k < 3; ++k) p[k] = mesh.positions[mesh.indices[i + k]];
        const glm::dvec3 cross = glm::cross(p[1] - p[0], p[2] - p[0]);
        if (glm::length(cross) == 0.0) continue;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 a = glm::normalize(p[(k + 1) % 3] - p[k]), b = glm::normalize(p[(k + 2) % 3] - p[k]);
            const double angle = std::acos(glm::clamp(glm::dot(a, b), -1.0, 1.0));
            sums[mesh.indices[i + k]] += angle * glm::normalize(cross);
        }
    }
    mesh.normals.resize(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i)
        mesh.normals[i] = glm::length(sums[i]) > 0.0 ? glm::vec3(glm::normalize(sums[i])) : glm::vec3(0, 1, 0);
}

void append(Mesh& mesh, const Mesh& other) {
    const auto offset = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
    mesh.uvs.insert(mesh.uvs.end(), other.uvs.begin(), other.uvs.end());
    for (std::uint32_t index : other.indices) mesh.indices.push_back(index + offset);
}

void transform(Mesh& mesh, const glm::mat4& matrix) {
    const glm::mat3 normalMatrix = glm::transpose(glm::inverse(glm::mat3(matrix)));
    for (glm::vec3& p : mesh.positions) p = glm::vec3(matrix * glm::vec4(p, 1.0f));
    for (glm::vec3& n : mesh.normals) n = glm::normalize(normalMatrix * n);
}

void standAt(Mesh& mesh, double y) {
    float lowest = mesh.positions.at(0).y;
    for (const glm::vec3& p : mesh.positions) lowest = std::min(lowest, p.y);
    for (glm::vec3& p : mesh.positions) p.y += static_cast<float>(y) - lowest;
}

Mesh icosphere(int levels, const glm::dvec3& centre, double radius) {
    const double phi = std::numbers::phi;
    std::vector<glm::dvec3> points{{-1, phi, 0}, {1, phi, 0}, {-1, -phi, 0}, {1, -phi, 0},
                                   {0, -1, phi}, {0, 1, phi}, {0, -1, -phi}, {0, 1, -phi},
                                   {phi, 0, -1}, {phi, 0, 1}, {-phi, 0, -1}, {-phi, 0, 1}};
    std::vector<std::uint32_t> faces{0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                                     4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                                     6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
    for (glm::dvec3& p : points) p = glm::normalize(p);
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [entry, isNew] =
                middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
            if (isNew) points.push_back(glm::normalize(points[a] + points[b]));
            return entry->second;
        };
        std::vector<std::uint32_t> finer;
        for (std::size_t i = 0; i < faces.size(); i += 3) {
            const std::uint32_t a = faces[i], b = faces[i + 1], c = faces[i + 2];
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
        }
        faces = std::move(finer);
    }
    Mesh mesh;
    mesh.indices = std::move(faces);
    for (const glm::dvec3& p : points) {
        mesh.positions.push_back(glm::vec3(centre + radius * p));
        mesh.normals.push_back(glm::vec3(p));
    }
    return mesh;
}

Mesh torus(double majorRadius, double minorRadius, int around, int across) {
    Mesh mesh;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double u = 2.0 * std::numbers::pi * i / around, v = 2.0 * std::numbers::pi * j / across;
            const glm::dvec3 out(std::cos(u), 0.0, -std::sin(u));
            const glm::dvec3 normal = std::cos(v) * out + glm::dvec3(0.0, std::sin(v), 0.0);
            mesh.positions.push_back(glm::vec3(majorRadius * out + minorRadius * normal));
            mesh.normals.push_back(glm::vec3(normal));
            const auto at = [&](int a, int b) {
                return static_cast<std::uint32_t>((a % around) * across + b % across);
            };
            mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1),  //
                                                     at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}

Mesh lathe(const std::vector<Profile>& curves, int around) {
    Mesh mesh;
    for (const Profile& curve : curves) {
        const auto base = static_cast<std::uint32_t>(mesh.positions.size());
        const auto count = static_cast<std::uint32_t>(curve.size());
        for (int i = 0; i < around; ++i) {
            const double u = 2.0 * std::numbers::pi * i / around;
            const glm::dvec3 out(std::cos(u), 0.0, -std::sin(u));
            for (std::size_t j = 0; j < curve.size(); ++j) {
                const glm::dvec2 along = curve[std::min(j + 1, curve.size() - 1)] - curve[j > 0 ? j - 1 : 0];
                const glm::dvec2 normal = glm::normalize(glm::dvec2(along.y, -along.x));
                mesh.positions.push_back(glm::vec3(curve[j].x * out + glm::dvec3(0.0, curve[j].y, 0.0)));
                // On the axis the two sides' normals meet: straight up or down.
                const glm::dvec3 turned = normal.x * out + glm::dvec3(0.0, normal.y, 0.0);
                mesh.normals.push_back(curve[j].x == 0.0 ? glm::vec3(0.0f, normal.y < 0.0 ? -1.0f : 1.0f, 0.0f)
                                                         : glm::vec3(turned));
            }
        }
        for (int i = 0; i < around; ++i)
            for (std::uint32_t j = 0; j + 1 < count; ++j) {
                const std::uint32_t a = base + static_cast<std::uint32_t>(i) * count + j;
                const std::uint32_t b = base + static_cast<std::uint32_t>((i + 1) % around) * count + j;
                if (curve[j].x > 0.0) mesh.indices.insert(mesh.indices.end(), {a, b, b + 1});
                if (curve[j + 1].x > 0.0) mesh.indices.insert(mesh.indices.end(), {a, b + 1, a + 1});
            }
    }
    return mesh;
}

Mesh quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
    const glm::vec3 normal = glm::normalize(glm::cross(b - a, d - a));
    return {{a, b, c, d}, {normal, normal, normal, normal}, {{0, 1}, {1, 1}, {1, 0}, {0, 0}}, {0, 1, 2, 0, 2, 3}};
}

Mesh box(const glm::vec3& lo, const glm::vec3& hi) {
    const auto at = [&](int x, int y, int z) { return glm::vec3(x ? hi.x : lo.x, y ? hi.y : lo.y, z ? hi.z : lo.z); };
    Mesh mesh;
    append(mesh, quad(at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)));
    append(mesh, quad(at(1, 0, 0), at(0, 0, 0), at(0, 1, 0), at(1, 1, 0)));
    append(mesh, quad(at(1, 0, 1), at(1, 0, 0), at(1, 1, 0), at(1, 1, 1)));
    append(mesh, quad(at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)));
    append(mesh, quad(at(0, 1, 1), at(1, 1, 1), at(1, 1, 0), at(0, 1, 0)));
    append(mesh, quad(at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)));
    return mesh;
}

double signedVolume(const Mesh& mesh) {
    double volume = 0.0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::dvec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                         c = mesh.positions[mesh.indices[i + 2]];
        volume += glm::dot(a, glm::cross(b, c)) / 6.0;
    }
    return volume;
}

void lineTo(Profile& curve, const glm::dvec2& b, int segments) {
    const glm::dvec2 a = curve.back();
    for (int i = 1; i <= segments; ++i) curve.push_back(glm::mix(a, b, static_cast<double>(i) / segments));
}

void bendTo(Profile& curve, const glm::dvec2& control, const glm::dvec2& b, int segments) {
    const glm::dvec2 a = curve.back();
    for (int i = 1; i <= segments; ++i) {
        const double t = static_cast<double>(i) / segments;
        curve.push_back(glm::mix(glm::mix(a, control, t), glm::mix(control, b, t), t));
    }
}

}  // namespace caustream::scenes
