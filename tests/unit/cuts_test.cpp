// The cut stones are what they are called.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "scenes/cuts.h"
#include "scenes/mesh.h"

namespace caustream::scenes {
namespace {

double angleDeg(const glm::dvec4& plane) { return std::acos(std::abs(plane.y)) * 180.0 / M_PI; }

// How many planes lie at each angle from the table's, above and below, in hundredths of a degree.
std::map<int, int> census(const std::vector<glm::dvec4>& planes) {
    std::map<int, int> count;
    for (const glm::dvec4& plane : planes) ++count[static_cast<int>(std::lround((plane.y < -1e-9 ? -1 : 1) * 100.0 * angleDeg(plane)))];
    return count;
}

TEST(Cuts, ABrilliantHasItsFacets) {
    const std::vector<glm::dvec4> planes = brilliantPlanes();
    const std::map<int, int> at = census(planes);
    EXPECT_EQ(planes.size(), 58u + 16u);
    EXPECT_EQ(at.at(3450), 8);            // mains
    EXPECT_EQ(at.at(-4075), 8);           // pavilion mains
    EXPECT_EQ(at.at(9000), 16);           // the girdle
    EXPECT_EQ(std::count_if(at.begin(), at.end(), [](const auto& entry) { return entry.second == 16; }), 3);   // and both halves
    EXPECT_EQ(std::count_if(at.begin(), at.end(), [](const auto& entry) { return entry.second == 8; }), 3);    // and the stars
}

// Every plane of a stone shows as a face, and the stone is as wide as it says.
TEST(Cuts, NoPlaneIsLost) {
    for (const auto& planes : {brilliantPlanes(), emeraldPlanes()}) {
        const Mesh mesh = convexPolyhedron(planes);
        for (const glm::dvec4& plane : planes) {
            const bool shows = std::any_of(mesh.normals.begin(), mesh.normals.end(), [&](const glm::vec3& n) { return glm::distance(glm::dvec3(n), glm::dvec3(plane)) < 1e-6; });
            EXPECT_TRUE(shows) << plane.x << " " << plane.y << " " << plane.z;
        }
        float reach = 0.0f;
        for (const glm::vec3& p : mesh.positions) reach = std::max(reach, std::max(std::abs(p.x), std::abs(p.z)));
        EXPECT_NEAR(reach, 1.0f, 1e-6f);
        EXPECT_LE(planes.size(), 128u);
    }
}

// Tolkowsky 1919: crown height 16.2%, pavilion depth 43.1% of the width.
TEST(Cuts, ABrilliantHasTolkowskysHeights) {
    const Mesh mesh = convexPolyhedron(brilliantPlanes());
    float top = 0.0f, bottom = 0.0f;
    for (const glm::vec3& p : mesh.positions) top = std::max(top, p.y), bottom = std::min(bottom, p.y);
    EXPECT_NEAR(top - 0.02f, 2.0f * 0.162f, 0.003f);
    EXPECT_NEAR(-bottom - 0.02f, 2.0f * 0.431f, 0.015f);   // the culet takes a little
}

}  // namespace
}  // namespace caustream::scenes
