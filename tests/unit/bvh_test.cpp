// A walk through the hierarchy finds every triangle once, whatever triangles there are.
#include "render/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace caustream::render {
namespace {

std::vector<Triangle> randomTriangles(std::size_t count, float size) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(-1.0f, 1.0f);
    const auto point = [&] { return glm::vec3(place(random), place(random), place(random)); };
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 at = point();
        triangles.push_back({{at, at + size * point(), at + size * point()}});
    }
    return triangles;
}

// Links go forward, each triangle is in one leaf, and every box around a leaf holds its triangles.
void expectSound(const Bvh& bvh, const std::vector<Triangle>& triangles, std::size_t usable) {
    ASSERT_EQ(bvh.triangles.size(), usable);
    EXPECT_EQ(std::set<std::uint32_t>(bvh.triangles.begin(), bvh.triangles.end()).size(), usable);
    std::vector<std::uint32_t> open;    // nodes around the one looked at
    std::size_t seen = 0;
    for (std::uint32_t i = 0; i < bvh.nodes.size(); ++i) {
        const glm::uvec4& node = bvh.nodes[i];
        std::erase_if(open, [&](std::uint32_t o) { return bvh.nodes[o].w <= i; });
        if (!(node.w & Bvh::kLeaf)) {
            ASSERT_GT(node.w, i + 1);
            ASSERT_LE(node.w, bvh.nodes.size());
            open.push_back(i);
            continue;
        }
        const std::uint32_t first = (node.w & ~Bvh::kLeaf) >> Bvh::kLeafBits, count = (node.w & 7u) + 1;
        ASSERT_EQ(first, seen);
        seen += count;
        open.push_back(i);
        for (std::uint32_t t = first; t < first + count; ++t) {
            for (const glm::vec3& corner : triangles[bvh.triangles[t]].corners) {
                const glm::vec3 cell = 1.0f + (corner - bvh.low) * bvh.cellsPerM;
                for (const std::uint32_t around : open) {
                    for (int k = 0; k < 3; ++k) {
                        const std::uint32_t packed = bvh.nodes[around][k];
                        ASSERT_LE(static_cast<float>(packed & 0xffffu), cell[k] - 0.5f);
                        ASSERT_GE(static_cast<float>(packed >> 16), cell[k] + 0.5f);
                    }
                }
            }
        }
        open.pop_back();
    }
    EXPECT_EQ(seen, usable);
}

TEST(Bvh, HoldsEveryTriangleOnce) {
    for (const std::size_t count : {1u, 2u, 9u, 20'000u}) {
        const auto triangles = randomTriangles(count, 0.05f);
        expectSound(buildBvh(triangles), triangles, count);
    }
}

TEST(Bvh, LeavesOutWhatIsNoTriangle) {
    auto triangles = randomTriangles(100, 0.1f);
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    triangles[3].corners[1].x = nan;
    triangles[50].corners[2].z = infinity;
    triangles[99].corners[1] = triangles[99].corners[0];
    expectSound(buildBvh(triangles), triangles, 97);
    EXPECT_TRUE(buildBvh({}).nodes.empty());
    const std::vector<Triangle> none(5, Triangle{{glm::vec3(nan), glm::vec3(0), glm::vec3(1)}});
    EXPECT_TRUE(buildBvh(none).nodes.empty());
}

// All in one place, on one plane, far from the origin, of very different sizes.
TEST(Bvh, BuildsOverTrianglesThatCannotBeTakenApart) {
    const std::vector<Triangle> same(5000, randomTriangles(1, 1.0f)[0]);
    expectSound(buildBvh(same), same, same.size());
    auto flat = randomTriangles(1000, 0.1f), far = flat, mixed = flat;
    for (std::size_t i = 0; i < flat.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            flat[i].corners[k].y = 0.0f;
            far[i].corners[k] += glm::vec3(0, 100, 0);
            mixed[i].corners[k] *= i % 2 ? 1e-4f : 10.0f;
        }
    }
    expectSound(buildBvh(flat), flat, flat.size());
    expectSound(buildBvh(far), far, far.size());
    expectSound(buildBvh(mixed), mixed, mixed.size());
}

TEST(Bvh, IsTheSameForTheSameTriangles) {
    const auto triangles = randomTriangles(5000, 0.05f);
    const Bvh a = buildBvh(triangles), b = buildBvh(triangles);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.nodes, b.nodes);
}

}  // namespace
}  // namespace caustream::render
