// Lights and cameras of a glTF file, loaded to known numbers; what is placed where a file has none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <glm/geometric.hpp>

#include "glb_editor.h"

namespace caustream::test {
namespace {

using scene::Scene;
using testing::ElementsAre;

Scene loaded(const Glb& glb) {
    auto scene = load(glb);
    if (!scene) {
        ADD_FAILURE() << scene.error().message;
        return {};
    }
    return std::move(*scene);
}

Glb withLight(const json& light, const json& node) {
    Glb glb = glassTetrahedron();
    glb.root["extensions"]["KHR_lights_punctual"]["lights"] = {light};
    glb.root["nodes"].push_back(node);
    glb.root["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    glb.root["scenes"][0]["nodes"] = {0, 1};
    return glb;
}

TEST(GltfLights, SpotLightShinesAlongMinusZ) {
    const double h = std::sqrt(0.5);
    const Scene scene = loaded(withLight({{"type", "spot"},
                                          {"name", "key"},
                                          {"intensity", 42.0},
                                          {"color", {1.0, 0.5, 0.25}},
                                          {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}},
                                         {{"translation", {0, 5, 0}}, {"rotation", {-h, 0, 0, h}}}));  // -Z -> -Y
    ASSERT_EQ(scene.lights.size(), 1u);
    const scene::Light& light = scene.lights[0];
    EXPECT_EQ(light.name, "key");
    EXPECT_EQ(light.type, scene::LightType::Spot);
    EXPECT_EQ(light.position, glm::vec3(0, 5, 0));
    EXPECT_LT(glm::distance(light.direction, glm::vec3(0, -1, 0)), 1e-6f);
    EXPECT_NEAR(light.innerConeDeg, 5.72958f, 1e-4f);
    EXPECT_NEAR(light.outerConeDeg, 11.4592f, 1e-4f);
    EXPECT_EQ(light.intensity, 42.0f);
    EXPECT_EQ(light.color, glm::vec3(1.0f, 0.5f, 0.25f));
}

TEST(GltfLights, PointLightIsAimedAtTheCasters) {
    const Scene scene = loaded(withLight({{"type", "point"}, {"intensity", 4000.0}}, {{"translation", {0.5, 5, 0.5}}}));
    EXPECT_EQ(scene.lights[0].name, "light");
    EXPECT_LT(glm::distance(scene.lights[0].direction, glm::vec3(0, -1, 0)), 1e-6f);
}

TEST(GltfLights, DirectionalLight) {
    const Scene scene = loaded(withLight({{"type", "directional"}, {"intensity", 1000.0}}, json::object()));
    EXPECT_EQ(scene.lights[0].type, scene::LightType::Directional);
    EXPECT_EQ(scene.lights[0].direction, glm::vec3(0, 0, -1));
}

TEST(GltfLights, LightSpectrumRidesInExtras) {
    json light{{"type", "point"}, {"extras", {{"caustream", {{"spectrum", {"blackbody", 3200}}}}}}};
    Scene scene = loaded(withLight(light, json::object()));
    ASSERT_TRUE(std::holds_alternative<optics::Blackbody>(scene.lights[0].spectrum));
    EXPECT_EQ(std::get<optics::Blackbody>(scene.lights[0].spectrum).kelvin, 3200.0);
    light["extras"]["caustream"]["spectrum"] = {"lines", 486.1, 656.3};
    scene = loaded(withLight(light, json::object()));
    ASSERT_TRUE(std::holds_alternative<optics::Lines>(scene.lights[0].spectrum));
    EXPECT_THAT(std::get<optics::Lines>(scene.lights[0].spectrum).nm, ElementsAre(486.1, 656.3));
}

TEST(GltfLights, LightsWithTheSameOrNoNameGetStableNames) {
    Glb glb = withLight({{"type", "point"}, {"name", "lamp"}}, json::object());
    json& lights = glb.root["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back({{"type", "point"}, {"name", "lamp"}});
    lights.push_back({{"type", "point"}});
    for (int i = 1; i < 3; ++i) {
        glb.root["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
        glb.root["scenes"][0]["nodes"].push_back(i + 1);
    }
    const Scene scene = loaded(glb);
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].name, "lamp");
    EXPECT_EQ(scene.lights[1].name, "lamp-1");
    EXPECT_EQ(scene.lights[2].name, "light-2");
}

TEST(GltfLights, CameraLooksAlongMinusZAtTheSubject) {
    Glb glb = glassTetrahedron();
    glb.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    glb.root["nodes"].push_back({{"camera", 0}, {"translation", {0.5, 0.5, 4.5}}});
    glb.root["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = loaded(glb);
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].eye, glm::vec3(0.5f, 0.5f, 4.5f));
    EXPECT_LT(glm::distance(scene.cameras[0].target, glm::vec3(0.5f, 0.5f, 0.5f)), 1e-5f);
    EXPECT_NEAR(scene.cameras[0].fovYDeg, 28.6479f, 1e-3f);
}

TEST(GltfLights, WhatIsMissingIsPlaced) {
    const Scene scene = loaded(glassTetrahedron());
    ASSERT_EQ(scene.lights.size(), 1u);
    ASSERT_EQ(scene.cameras.size(), 1u);
    ASSERT_EQ(scene.geometry->objects.size(), 2u);
    EXPECT_TRUE(warns(scene, "no light"));
    EXPECT_TRUE(warns(scene, "no camera"));
    EXPECT_TRUE(warns(scene, "floor"));
    // The light shines on the glass, and on through it to the floor.
    const scene::Light& light = scene.lights[0];
    const glm::vec3 centre = scene.geometry->casterBounds.centre();
    EXPECT_GT(glm::dot(light.direction, glm::normalize(centre - light.position)), 0.999f);
    const scene::Bounds& floor = scene.geometry->objects[1].bounds;
    EXPECT_LT(floor.max.y, scene.geometry->casterBounds.min.y);
    const float along = (floor.max.y - light.position.y) / light.direction.y;
    const glm::vec3 spot = light.position + along * light.direction;
    EXPECT_TRUE(spot.x > floor.min.x && spot.x < floor.max.x && spot.z > floor.min.z && spot.z < floor.max.z);
    EXPECT_EQ(scene.geometry->vertices[scene.geometry->indices.back()].normal, glm::vec3(0, 1, 0));
}

// What Blender writes for its start-up file: a cube, a point light in candela, a camera, no glass.
TEST(GltfLights, BlendersDefaultFileLoads) {
    Glb glb = withLight({{"type", "point"}, {"name", "Light"}, {"intensity", 54351.41}},
                        {{"name", "Light"}, {"translation", {4.07625, 5.90386, -1.00545}}});
    glb.root["materials"] = {
        {{"name", "Material"},
         {"doubleSided", true},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {0.8, 0.8, 0.8, 1.0}}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}}}}};
    glb.root["extensionsUsed"] = {"KHR_lights_punctual"};
    const Scene scene = loaded(glb);
    EXPECT_EQ(scene.lights[0].name, "Light");
    EXPECT_TRUE(scene.geometry->casterBounds.empty());
    EXPECT_TRUE(warns(scene, "nothing in the file is transmissive"));
    EXPECT_TRUE(scene.materials[0].doubleSided);
}

}  // namespace
}  // namespace caustream::test
