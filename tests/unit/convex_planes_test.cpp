// Which objects are convex solids of few flat faces, whatever their triangles look like.
#include "render/convex_planes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "render/exact_surfaces.h"
#include "scene/builtin_scenes.h"

namespace caustream::render {
namespace {

using Corners = std::vector<glm::dvec3>;   // three a triangle, counter-clockwise seen from outside

Corners box(const glm::dvec3& low, const glm::dvec3& high) {
    Corners corners;
    for (int axis = 0; axis < 3; ++axis) {
        for (int side = 0; side < 2; ++side) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            std::array<glm::dvec3, 4> p;
            for (int k = 0; k < 4; ++k) {
                p[k][axis] = side ? high[axis] : low[axis];
                p[k][u] = (k == 1 || k == 2) ? high[u] : low[u];
                p[k][v] = k >= 2 ? high[v] : low[v];
            }
            for (const int k : side ? std::array{0, 1, 2, 0, 2, 3} : std::array{0, 2, 1, 0, 3, 2}) corners.push_back(p[k]);
        }
    }
    return corners;
}
Corners cube() { return box(glm::dvec3(-1.0), glm::dvec3(1.0)); }

// Each triangle into four.
Corners subdivided(const Corners& corners) {
    Corners result;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        const glm::dvec3 a = corners[i], b = corners[i + 1], c = corners[i + 2], ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
        for (const glm::dvec3& p : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca}) result.push_back(p);
    }
    return result;
}

Corners shuffled(const Corners& corners, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::size_t> order(corners.size() / 3);
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), random);
    Corners result;
    for (const std::size_t i : order) {
        const std::size_t turn = random() % 3;
        for (std::size_t k = 0; k < 3; ++k) result.push_back(corners[3 * i + (k + turn) % 3]);
    }
    return result;
}

Corners moved(Corners corners, const glm::dmat4& by) {
    for (glm::dvec3& p : corners) p = glm::dvec3(by * glm::dvec4(p, 1.0));
    return corners;
}

// Flat normals, or those from the middle of the object.
scene::Geometry geometryOf(const Corners& corners, bool smooth = false) {
    scene::Geometry geometry;
    scene::Object object;
    object.name = "thing";
    object.indexCount = static_cast<std::uint32_t>(corners.size());
    for (const glm::dvec3& p : corners) object.bounds.add(glm::vec3(p));
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::size_t t = i / 3 * 3;
        const glm::dvec3 flat = glm::normalize(glm::cross(corners[t + 1] - corners[t], corners[t + 2] - corners[t]));
        const glm::dvec3 normal = smooth ? glm::normalize(corners[i] - glm::dvec3(object.bounds.centre())) : flat;
        geometry.indices.push_back(static_cast<std::uint32_t>(i));
        geometry.vertices.push_back({glm::vec3(corners[i]), glm::vec3(normal)});
    }
    geometry.objects.push_back(object);
    geometry.bounds = object.bounds;
    return geometry;
}

ConvexShape shapeOf(const Corners& corners, bool smooth = false) {
    const scene::Geometry geometry = geometryOf(corners, smooth);
    return findConvexShape(geometry, geometry.objects[0]);
}

// The first caster of a built-in scene, and its triangles.
struct Builtin {
    std::shared_ptr<const scene::Geometry> geometry;
    std::size_t caster = 0;
    Corners corners;
    explicit Builtin(const std::string& name) {
        const auto scene = scene::loadBuiltin(name);
        geometry = scene->geometry;
        while (!scene->materials[static_cast<std::size_t>(geometry->objects[caster].material)].caster) ++caster;
        const scene::Object& object = geometry->objects[caster];
        for (std::uint32_t i = 0; i < object.indexCount; ++i) {
            corners.emplace_back(geometry->vertices[geometry->indices[object.firstIndex + i]].position);
        }
    }
    ConvexShape shape() const { return findConvexShape(*geometry, geometry->objects[caster]); }
};

TEST(ConvexPlanes, AreFoundInTheBuiltinSolids) {
    EXPECT_EQ(Builtin("prism").shape().planes.size(), 5u);
    const ConvexShape gem = Builtin("gem").shape();
    EXPECT_EQ(gem.planes.size(), 24u);
    EXPECT_EQ(gem.why, "24 planes, closed and convex");
}

TEST(ConvexPlanes, OfACubeAreItsSides) {
    const ConvexShape shape = shapeOf(box({-1, 2, -3}, {1, 4, 5}));
    ASSERT_EQ(shape.planes.size(), 6u);
    for (const glm::dvec4& expected : {glm::dvec4(-1, 0, 0, 1), {1, 0, 0, 1}, {0, -1, 0, -2}, {0, 1, 0, 4}, {0, 0, -1, 3}, {0, 0, 1, 5}}) {
        EXPECT_TRUE(std::any_of(shape.planes.begin(), shape.planes.end(), [&](const glm::dvec4& p) { return glm::distance(p, expected) < 1e-6; }));
    }
}

TEST(ConvexPlanes, DoNotDependOnTrianglesPlaceTurnOrSize) {
    for (const auto& [name, corners, planes] : {std::tuple<std::string, Corners, std::size_t>{"gem", Builtin("gem").corners, 24u},
                                                {"prism", Builtin("prism").corners, 5u}, {"cube", cube(), 6u}}) {
        SCOPED_TRACE(name);
        for (const double scale : {1e-3, 1.0, 1e4}) {
            for (const double turn : {0.0, 0.7, 2.5}) {
                SCOPED_TRACE(scale);
                glm::dmat4 by = glm::translate(glm::dmat4(1.0), 2.0 * scale * glm::dvec3(0.3, -0.2, 0.5));
                by = glm::scale(glm::rotate(by, turn, glm::normalize(glm::dvec3(1, 2, -0.5))), glm::dvec3(scale));
                const Corners there = moved(corners, by);
                EXPECT_EQ(shapeOf(there).planes.size(), planes);
                EXPECT_EQ(shapeOf(shuffled(there, 1)).planes.size(), planes);
                EXPECT_EQ(shapeOf(shuffled(subdivided(subdivided(there)), 2)).planes.size(), planes);
            }
        }
    }
}

// A corner cut off by a ten thousandth gives triangles that are slivers or next to nothing; still six sides and one more.
TEST(ConvexPlanes, SurviveSliversInAFace) {
    Corners corners = cube();
    const glm::dvec3 a = corners[0], b = corners[1], c = corners[2], near = a + 1e-7 * (b - a) + 1e-7 * (c - a);
    corners.erase(corners.begin(), corners.begin() + 3);
    for (const glm::dvec3& p : {a, b, near, b, c, near, c, a, near}) corners.push_back(p);
    EXPECT_EQ(shapeOf(corners).planes.size(), 6u);
}

TEST(ConvexPlanes, AreNotSeenInWhatIsNotSuchASolid) {
    EXPECT_THAT(shapeOf(cube(), true).why, testing::HasSubstr("interpolated normals"));
    Corners open = cube();
    open.resize(open.size() - 3);
    EXPECT_THAT(shapeOf(open).why, testing::HasSubstr("not closed"));
    Corners two = cube();
    for (const glm::dvec3& p : box(glm::dvec3(2.0), glm::dvec3(3.0))) two.push_back(p);
    EXPECT_THAT(shapeOf(two).why, testing::HasSubstr("not convex"));
    Corners twice = cube();
    for (const glm::dvec3& p : cube()) twice.push_back(p);
    EXPECT_FALSE(shapeOf(twice).convex());
    Corners dent = subdivided(cube());
    for (glm::dvec3& p : dent) {
        if (p == glm::dvec3(0, 0, 1)) p.z = 0.9;
    }
    EXPECT_THAT(shapeOf(dent).why, testing::HasSubstr("not convex"));
    Corners inverted = cube();
    for (std::size_t i = 0; i < inverted.size(); i += 3) std::swap(inverted[i], inverted[i + 1]);
    EXPECT_FALSE(shapeOf(inverted).convex());
    EXPECT_FALSE(shapeOf({}).convex());
    EXPECT_FALSE(shapeOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).convex());
    EXPECT_FALSE(shapeOf(Corners(12, glm::dvec3(1.0))).convex());
    for (const char* name : {"sphere", "ring", "bunny"}) EXPECT_FALSE(Builtin(name).shape().convex()) << name;
}

TEST(ConvexPlanes, AreLookedForOnceAGeometry) {
    const Builtin gem("gem");
    EXPECT_EQ(convexShape(gem.geometry, gem.caster).get(), convexShape(gem.geometry, gem.caster).get());
}

TEST(ExactCasters, ComeInOrderOfPriorityThenOfTheFile) {
    scene::Scene scene;
    auto geometry = std::make_shared<scene::Geometry>();
    const auto add = [&](int priority, bool mirror, bool thin, bool caster) {
        const scene::Geometry one = geometryOf(cube());
        scene::Object object = one.objects[0];
        object.material = static_cast<int>(scene.materials.size());
        object.firstIndex = static_cast<std::uint32_t>(geometry->indices.size());
        for (const std::uint32_t i : one.indices) geometry->indices.push_back(i + static_cast<std::uint32_t>(geometry->vertices.size()));
        geometry->vertices.insert(geometry->vertices.end(), one.vertices.begin(), one.vertices.end());
        geometry->objects.push_back(object);
        scene::Material material;
        material.caster = caster;
        material.mirror = mirror;
        material.thinWalled = thin;
        material.priority = priority;
        scene.materials.push_back(material);
    };
    add(0, false, false, true);
    add(1, false, true, true);
    add(2, false, false, true);
    add(0, true, false, false);
    add(0, false, false, false);
    scene.geometry = geometry;
    const auto casters = exactCasters(scene);
    ASSERT_EQ(casters.size(), 3u);
    EXPECT_EQ(casters[0].object, 2u);
    EXPECT_EQ(casters[1].object, 0u);
    EXPECT_EQ(casters[2].object, 3u);
    EXPECT_TRUE(casters[2].mirror);
    EXPECT_EQ(casters[0].planes, 6);
}

}  // namespace
}  // namespace caustream::render
