// camera_receivers against closed forms of irradiance.
#include <glm/gtc/constants.hpp>

#include "render/light_uniforms.h"
#include "render/passes/camera_receivers.h"
#include "tests/gpu/camera_fixture.h"

namespace caustream::tests {
namespace {

using render::CameraReceivers;
using render::Lighting;
using render::View;

class CameraReceiversTest : public CameraPass {
   protected:
    // Radiance in W m^-2 sr^-1.
    std::vector<glm::vec4> shade(const SyntheticScene& scene, const Lighting& lighting, const View& view) {
        const render::GpuScene gpu(scene.geometry());
        CameraReceivers(shaders_).run({gpu, scene.materials, lighting, view, kSize, kSize}, {color_, depth_});
        std::vector<glm::vec4> radiance = readTexture(color_);
        for (glm::vec4& texel : radiance) texel *= render::radianceUnit(lighting);
        return radiance;
    }

    // Depth of everything in `scene` from the light, as a shadow pass would leave it.
    void castShadow(const SyntheticScene& scene, const View& view, Lighting& lighting) {
        const render::GpuScene gpu(scene.geometry());
        gl::Texture ignored;
        CameraReceivers(shaders_).run({gpu, scene.materials, Lighting{}, view, 256, 256}, {ignored, shadow_});
        lighting.hasShadow = true;
        lighting.shadowView = view;
        lighting.shadowDepth = shadow_.get();
    }

    static gl::Texture constantMap(const glm::vec4& value) {
        gl::Texture map(16, 16, GL_RGBA32F, "map");
        fillTexture(map, std::vector<glm::vec4>(256, value));
        return map;
    }

    // From the light above the floor of most tests.
    static void project(const gl::Texture& map, const gl::Texture& outer, Lighting& lighting) {
        lighting.hasMap = true;
        lighting.map = map.get();
        lighting.outerMap = outer.get();
        lighting.mapView = lookingAt({0, 2, 0}, {0, 0, 0}, 150.0f);
        lighting.outerView = lookingAt({0, 2, 0}, {0, 0, 0}, 170.0f);
    }

    // Where the view's ray through the centre of a pixel meets the plane y = 0.
    static glm::vec3 onFloor(const View& view, int x, int y) {
        const glm::vec2 xy = (2.0f * (glm::vec2(x, y) + 0.5f) / float(kSize) - 1.0f) * view.halfExtent;
        const glm::vec3 dir = glm::transpose(glm::mat3(view.worldToView)) * glm::vec3(xy, -1.0f);
        const glm::vec3 eye = view.position();
        return eye - dir * (eye.y / dir.y);
    }

    static SyntheticScene floor(const scene::Material& material) {
        SyntheticScene scene;
        scene.addQuad(scene.material(material), {-20, 0, 20}, {40, 0, 0}, {0, 0, -40});
        return scene;
    }

    const View above_ = lookingAt({0, 3, 2}, {0, 0, 0}, 50.0f);
    gl::Texture color_, depth_, shadow_;
};

TEST_F(CameraReceiversTest, EveryVariantCompiles) { CameraReceivers(shaders_).warmUp(); }

TEST_F(CameraReceiversTest, WhiteFloorUnderASpotHasTheClosedForm) {
    const scene::Light light = spotAt({0.3f, 2, 0.2f}, {0, -1, 0}, 100.0f);
    const auto radiance = shade(floor(matte(glm::vec3(1.0f))), litBy(light), above_);
    for (int y = 0; y < kSize; y += 7) {
        for (int x = 0; x < kSize; x += 7) {
            const glm::vec3 to = light.position - onFloor(above_, x, y);
            const float r = glm::length(to), cosine = to.y / r;
            const float expected = cosine > 0.5f ? 100.0f * cosine / (r * r) / glm::pi<float>() : 0.0f;
            if (std::abs(cosine - 0.5f) < 0.02f) continue;  // the cone's edge, one pixel wide
            // Half floats hold 11 bits; the rest is the interpolated position.
            EXPECT_NEAR(radiance[std::size_t(y * kSize + x)].g, expected, 1.5e-3f * expected + 1e-6f) << x << " " << y;
        }
    }
}

TEST_F(CameraReceiversTest, SoftConeFollowsGltf) {
    scene::Light light = spotAt({0, 2, 0}, {0, -1, 0}, 100.0f);
    light.innerConeDeg = 10.0f;
    light.outerConeDeg = 40.0f;
    const auto radiance = shade(floor(matte(glm::vec3(1.0f))), litBy(light), above_);
    const float outer = std::cos(glm::radians(40.0f)), inner = std::cos(glm::radians(10.0f));
    for (int i = 0; i < kSize * kSize; i += 37) {
        const glm::vec3 to = light.position - onFloor(above_, i % kSize, i / kSize);
        const float r = glm::length(to), cosine = to.y / r;
        const float ramp = glm::clamp((cosine - outer) / (inner - outer), 0.0f, 1.0f);
        const float expected = 100.0f * ramp * ramp * cosine / (r * r) / glm::pi<float>();
        EXPECT_NEAR(radiance[std::size_t(i)].g, expected, 2e-3f * expected + 1e-3f);
    }
}

TEST_F(CameraReceiversTest, ConcentrationOfOneDoublesTheLight) {
    Lighting lighting = litBy(spotAt({0, 2, 0}, {0, -1, 0}, 100.0f));
    const SyntheticScene scene = floor(matte(glm::vec3(0.5f)));
    const auto once = shade(scene, lighting, above_);

    const gl::Texture map = constantMap(glm::vec4(1.0f)), outer = constantMap(glm::vec4(0, 0, 0, 1));
    project(map, outer, lighting);
    const auto twice = shade(scene, lighting, above_);
    for (std::size_t i = 0; i < once.size(); ++i) {
        const glm::vec3 at = onFloor(above_, int(i) % kSize, int(i) / kSize);
        if (glm::length(glm::vec2(at.x, at.z)) > 3.0f) continue;  // near the cone's edge or beyond it
        EXPECT_NEAR(twice[i].g, 2.0f * once[i].g, 3e-3f * once[i].g) << i;
    }
}

TEST_F(CameraReceiversTest, WhatHidesBehindTheMapsReceiverGetsNoneOfItsLight) {
    Lighting lighting = litBy(spotAt({0, 2, 0}, {0, -1, 0}, 100.0f));
    const SyntheticScene scene = floor(matte(glm::vec3(0.5f)));
    const auto once = shade(scene, lighting, above_);
    const std::size_t centre = kSize * kSize / 2 + kSize / 2;
    const gl::Texture outer = constantMap(glm::vec4(0, 0, 0, 1));
    for (const float depth : {1.0f, 2.0f, 3.0f}) {  // of the receiver that the light lies on; the floor is 2 m away
        const gl::Texture map = constantMap(glm::vec4(1, 1, 1, lighting.mapView.nearM / depth));
        project(map, outer, lighting);
        EXPECT_NEAR(shade(scene, lighting, above_)[centre].g, (depth < 2.0f ? 1.0f : 2.0f) * once[centre].g, 0.01f);
    }
}

TEST_F(CameraReceiversTest, DirectionalLightIsItsLux) {
    scene::Light sun;
    sun.type = scene::LightType::Directional;
    sun.direction = glm::normalize(glm::vec3(1, -1, 0));
    sun.intensity = 1000.0f;
    const auto radiance = shade(floor(matte(glm::vec3(0.5f))), litBy(sun), above_);
    const float expected = 0.5f * 1000.0f * std::sqrt(0.5f) / glm::pi<float>();
    for (const glm::vec4& texel : radiance) EXPECT_NEAR(texel.r, expected, 1e-3f * expected);
}

TEST_F(CameraReceiversTest, BaseColourTextureIsSrgb) {
    scene::Material material = matte(glm::vec3(1.0f));
    material.baseColorTexture = 0;
    SyntheticScene scene = floor(material);
    scene.edit().textures.push_back({1, 1, {188, 188, 188, 255}});
    scene::Light sun;
    sun.type = scene::LightType::Directional;
    sun.intensity = 1.0f;
    const auto radiance = shade(scene, litBy(sun), above_);
    EXPECT_NEAR(radiance[0].g, 0.5029f / glm::pi<float>(), 1e-3f);  // 188 is 0.5029 linear
}

TEST_F(CameraReceiversTest, SecondLightAddsWithoutShadow) {
    scene::Light sun;
    sun.type = scene::LightType::Directional;
    sun.intensity = 1.0f;
    Lighting lighting = litBy(sun);
    sun.intensity = 0.5f;
    lighting.lights.push_back(sun);
    lighting.rgb.push_back({1, 0, 0});
    const auto radiance = shade(floor(matte(glm::vec3(1.0f))), lighting, above_);
    EXPECT_NEAR(radiance[0].r, 1.5f / glm::pi<float>(), 1e-3f);
    EXPECT_NEAR(radiance[0].g, 1.0f / glm::pi<float>(), 1e-3f);
}

TEST_F(CameraReceiversTest, APlaneDoesNotShadowItself) {
    const scene::Light light = spotAt({3, 1.5f, 0}, {-1, -0.5f, 0}, 100.0f);  // grazing: acne would show
    Lighting lighting = litBy(light);
    const SyntheticScene scene = floor(matte(glm::vec3(1.0f)));
    const auto without = shade(scene, lighting, above_);
    castShadow(scene, lookingAt(light.position, light.position + light.direction, 120.0f), lighting);
    const auto with = shade(scene, lighting, above_);
    int darker = 0;
    for (std::size_t i = 0; i < with.size(); ++i) darker += with[i] != without[i];
    EXPECT_EQ(darker, 0);
}

TEST_F(CameraReceiversTest, ABoxShadowsTheFloorUpToItsFoot) {
    const scene::Light light = spotAt({-2, 2, 0}, {1, -1, 0}, 100.0f);
    Lighting lighting = litBy(light);
    SyntheticScene scene = floor(matte(glm::vec3(1.0f)));
    scene.addBox(0, {-0.4f, 0, -0.5f}, {0, 1, 0.5f});
    castShadow(scene, lookingAt(light.position, light.position + light.direction, 90.0f), lighting);
    const View top = parallelView({0, 5, 0}, {0, 0, 0.0001f}, 2.0f);
    const auto radiance = shade(scene, lighting, top);
    int dark = 0, lit = 0;
    for (int i = 0; i < kSize * kSize; ++i) {
        const glm::vec2 xz = (2.0f * (glm::vec2(i % kSize, i / kSize) + 0.5f) / float(kSize) - 1.0f) * 2.0f;
        const glm::vec3 world = glm::transpose(glm::mat3(top.worldToView)) * glm::vec3(xz, 0.0f);
        // The box's top edge at (0, 1) throws its shadow to x = 2; at the foot x = 0 nothing may leak.
        if (world.x > 0.06f && world.x < 1.9f && std::abs(world.z) < 0.4f) dark += radiance[std::size_t(i)].g == 0.0f;
        if (world.x > 0.06f && world.x < 1.9f && std::abs(world.z) < 0.4f) ++lit;
    }
    EXPECT_EQ(dark, lit);
    EXPECT_GT(lit, 100);
}

TEST_F(CameraReceiversTest, ASheetIsLitOnTheLightsSideOnly) {
    SyntheticScene scene;
    scene.addQuad(scene.material(matte(glm::vec3(1.0f))), {-5, -5, 0}, {10, 0, 0}, {0, 10, 0});
    const Lighting lighting = litBy(spotAt({0, 0, 1}, {0, 0, -1}, 10.0f));
    const std::size_t centre = kSize * kSize / 2 + kSize / 2;
    EXPECT_GT(shade(scene, lighting, lookingAt({0.5f, 0, 2}, {0, 0, 0}, 40.0f))[centre].g, 1.0f);
    EXPECT_EQ(shade(scene, lighting, lookingAt({0.5f, 0, -2}, {0, 0, 0}, 40.0f))[centre].g, 0.0f);
}

TEST_F(CameraReceiversTest, DegenerateInputStaysFinite) {
    SyntheticScene scene = floor(matte(glm::vec3(0.8f)));
    scene.addFlat(0, {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}});                  // zero area: its normal is not a number
    scene.addQuad(0, {-1, 0.5f, 0}, {2, 0, 0}, {0, 0, -1});
    for (scene::Vertex& vertex : scene.edit().vertices) vertex.normal = glm::vec3(0.0f);
    scene::Light light = spotAt({0, 0, 0}, {0, -1, 0}, 1e30f);           // in the floor, and beyond any half float
    Lighting lighting = litBy(light);
    lighting.referenceIrradiance = 0.0f;
    castShadow(scene, lookingAt({0, 0, 0}, {0, -1, 0}, 120.0f), lighting);
    EXPECT_TRUE(allFinite(shade(scene, lighting, above_)));
    EXPECT_TRUE(allFinite(shade(scene, Lighting{}, above_)));
}

}  // namespace
}  // namespace caustream::tests
