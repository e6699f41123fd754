// The scene maker's shapes: face counts, closedness and volumes against closed forms.
#include <gtest/gtest.h>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <tuple>

#include "scenes/mesh.h"

namespace caustream::scenes {
namespace {

constexpr double kPi = std::numbers::pi;

bool closed(const Mesh& mesh) {
    std::map<std::tuple<float, float, float>, int> numbers;
    std::map<std::pair<int, int>, int> edges;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const auto number = [&](std::size_t corner) {
            const glm::vec3 p = mesh.positions[mesh.indices[corner]] + 0.0f;
            return numbers.try_emplace({p.x, p.y, p.z}, static_cast<int>(numbers.size())).first->second;
        };
        const int a = number(i), b = number(i / 3 * 3 + (i + 1) % 3);
        ++edges[{a, b}];
    }
    for (const auto& [edge, count] : edges) {
        const auto back = edges.find({edge.second, edge.first});
        if (count != 1 || back == edges.end() || back->second != 1) return false;
    }
    return true;
}

TEST(Mesh, IcosphereIsASphere) {
    const Mesh mesh = icosphere(4, {1.0, 2.0, 3.0}, 0.5);
    EXPECT_EQ(mesh.indices.size() / 3, 5120u);
    EXPECT_TRUE(closed(mesh));
    EXPECT_NEAR(signedVolume(mesh), 4.0 / 3.0 * kPi * 0.125, 0.003 * 0.5236);  // inscribed: a little less
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_NEAR(glm::distance(mesh.positions[i], glm::vec3(1, 2, 3)), 0.5f, 1e-6f);
        EXPECT_NEAR(glm::length(mesh.normals[i]), 1.0f, 1e-6f);
    }
}

TEST(Mesh, TorusIsATorus) {
    const Mesh mesh = torus(1.0, 0.25, 256, 128);
    EXPECT_EQ(mesh.indices.size() / 3, 65'536u);
    EXPECT_TRUE(closed(mesh));
    EXPECT_NEAR(signedVolume(mesh), 2.0 * kPi * kPi * 0.0625, 1e-3);
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3 * 997) {
        const glm::vec3 a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
                        c = mesh.positions[mesh.indices[t + 2]];
        EXPECT_GT(glm::dot(glm::cross(b - a, c - a), mesh.normals[mesh.indices[t]]), 0.0f);
    }
}

TEST(Mesh, PolyhedronOfSixPlanesIsABox) {
    const std::vector<glm::dvec4> planes{{1, 0, 0, 2}, {-1, 0, 0, 1}, {0, 1, 0, 3},     {0, -1, 0, 0},
                                         {0, 0, 1, 1}, {0, 0, -1, 1}, {0.6, 0.8, 0, 99}};  // the last cuts nothing off
    const Mesh mesh = convexPolyhedron(planes);
    EXPECT_EQ(mesh.indices.size() / 3, 12u);
    EXPECT_TRUE(closed(mesh));
    EXPECT_NEAR(signedVolume(mesh), 18.0, 1e-5);
}

TEST(Mesh, BoxAndQuadFaceOutAndUp) {
    const Mesh solid = box({0, 0, 0}, {1, 2, 3});
    EXPECT_TRUE(closed(solid));
    EXPECT_NEAR(signedVolume(solid), 6.0, 1e-6);
    EXPECT_EQ(quad({0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {0, 0, 0}).normals[0], glm::vec3(0, 1, 0));
}

// A cone frustum's wall, base and top: volume pi h (R^2 + R r + r^2) / 3.
TEST(Mesh, LatheClosesAtTheAxisAndAtItsEdges) {
    const std::vector<Profile> curves{{{0.0, 0.0}, {1.0, 0.0}}, {{1.0, 0.0}, {0.5, 2.0}}, {{0.5, 2.0}, {0.0, 2.0}}};
    const Mesh mesh = lathe(curves, 256);
    EXPECT_EQ(mesh.indices.size() / 3, 256u * 4u);  // two discs of one triangle a step, a wall of two
    EXPECT_TRUE(closed(mesh));
    EXPECT_NEAR(signedVolume(mesh), kPi * 2.0 * 1.75 / 3.0, 1e-3);
    EXPECT_EQ(mesh.normals.front(), glm::vec3(0, -1, 0));
    EXPECT_EQ(mesh.normals.back(), glm::vec3(0, 1, 0));
}

TEST(Mesh, SmoothNormalsOfASphereAreRadial) {
    Mesh mesh = icosphere(3, {0.0, 0.0, 0.0}, 1.0);
    mesh.normals.clear();
    smoothNormals(mesh);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        EXPECT_LT(glm::distance(mesh.normals[i], mesh.positions[i]), 0.01f);
}

}  // namespace
}  // namespace caustream::scenes
