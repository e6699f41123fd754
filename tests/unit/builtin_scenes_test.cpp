// The scenes that come with the server load without a warning, closed, lit and looked at.
#include <gtest/gtest.h>
#include <algorithm>
#include <glm/geometric.hpp>
#include <map>

#include "scene/builtin_scenes.h"
#include "scene/mesh_cleaning.h"

namespace caustream::scene {
namespace {

Part partOf(const Geometry& geometry, const Object& object) {
    return {geometry.vertices,
            {geometry.indices.begin() + object.firstIndex,
             geometry.indices.begin() + object.firstIndex + object.indexCount}};
}

std::vector<std::string> names() {
    std::vector<std::string> result;
    for (const BuiltinScene& scene : builtinScenes()) result.emplace_back(scene.name);
    return result;
}

class Builtin : public testing::TestWithParam<std::string> {};

TEST_P(Builtin, LoadsWithoutAWarning) {
    const auto scene = loadBuiltin(GetParam());
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->name, GetParam());
    for (const std::string& warning : scene->warnings) ADD_FAILURE() << warning;
    ASSERT_EQ(scene->lights.size(), 1u);
    EXPECT_EQ(scene->lights[0].name, "key");
    EXPECT_EQ(scene->cameras.size(), 1u);
    EXPECT_FALSE(scene->geometry->casterBounds.empty());
}

TEST_P(Builtin, CastersAreClosedAndOutsideOut) {
    const auto scene = loadBuiltin(GetParam());
    ASSERT_TRUE(scene);
    for (const Object& object : scene->geometry->objects) {
        if (!scene->materials[object.material].caster) continue;
        const Topology topology = examine(partOf(*scene->geometry, object));
        EXPECT_TRUE(topology.closed) << object.name;
        EXPECT_GT(topology.volume, 0.0) << object.name;
    }
}

TEST_P(Builtin, VerticesAreFiniteWithUnitNormals) {
    const auto scene = loadBuiltin(GetParam());
    ASSERT_TRUE(scene);
    for (const Vertex& vertex : scene->geometry->vertices) {
        ASSERT_LT(glm::length(vertex.position), 100.0f);
        ASSERT_NEAR(glm::length(vertex.normal), 1.0f, 1e-4f);
    }
}

TEST_P(Builtin, TheLightMeetsTheCaster) {
    const auto scene = loadBuiltin(GetParam());
    ASSERT_TRUE(scene);
    const Light& light = scene->lights[0];
    const Bounds& caster = scene->geometry->casterBounds;
    const glm::vec3 towards = caster.centre() - light.position;
    const glm::vec3 nearest = light.position + glm::dot(towards, light.direction) * light.direction;
    EXPECT_LT(glm::distance(nearest, caster.centre()), caster.radius());
}

INSTANTIATE_TEST_SUITE_P(All, Builtin, testing::ValuesIn(names()), [](const auto& entry) { return entry.param; });

TEST(BuiltinScenes, UnknownNamesListTheKnown) {
    const auto scene = loadBuiltin("teapot");
    ASSERT_FALSE(scene);
    for (const std::string& name : names()) EXPECT_NE(scene.error().message.find(name), std::string::npos);
}

TEST(BuiltinScenes, AreTheThesiss) {
    const std::map<std::string, std::uint32_t> faces{{"sphere", 5120}, {"ring", 65'536}};
    for (const auto& [name, count] : faces) {
        const auto scene = loadBuiltin(name);
        ASSERT_TRUE(scene) << scene.error().message;
        std::uint32_t glass = 0;
        for (const Object& object : scene->geometry->objects)
            if (scene->materials[object.material].caster) glass += object.indexCount / 3;
        EXPECT_EQ(glass, count) << name;
    }
    for (const char* name : {"gem", "glass", "prism"}) EXPECT_TRUE(loadBuiltin(name)) << name;
}

}  // namespace
}  // namespace caustream::scene
