// What tests of the camera's passes share: a context, read-back, and lights and views in one line.
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/trigonometric.hpp>
#include <vector>

#include "gl/context.h"
#include "gl/debug.h"
#include "gl/shader_library.h"
#include "render/lighting.h"
#include "render/view.h"
#include "tests/gpu/synthetic_scene.h"

namespace caustream::tests {

class CameraPass : public testing::Test {
   protected:
    CameraPass() : context_(gl::Context::create({"software"})) { glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE); }
    ~CameraPass() override { EXPECT_THAT(gl::takeDebugMessages(), testing::IsEmpty()); }

    static constexpr int kSize = 64;
    std::unique_ptr<gl::Context> context_;
    gl::ShaderLibrary shaders_;
};

// Four floats a texel, rows bottom to top.
inline std::vector<glm::vec4> readTexture(const gl::Texture& texture) {
    std::vector<glm::vec4> texels(std::size_t(texture.width()) * texture.height());
    glGetTextureImage(texture.get(), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(texels.size() * sizeof(glm::vec4)),
                      texels.data());
    return texels;
}

inline void fillTexture(const gl::Texture& texture, const std::vector<glm::vec4>& texels) {
    glTextureSubImage2D(texture.get(), 0, 0, 0, texture.width(), texture.height(), GL_RGBA, GL_FLOAT, texels.data());
}

inline bool allFinite(const std::vector<glm::vec4>& texels) {
    for (const glm::vec4& texel : texels) {
        for (int i = 0; i < 4; ++i) {
            if (!std::isfinite(texel[i])) return false;
        }
    }
    return true;
}

inline render::View lookingAt(const glm::vec3& eye, const glm::vec3& target, float fovDeg) {
    render::View view;
    view.worldToView = render::lookAlong(eye, glm::normalize(target - eye), glm::vec3(0, 1, 0));
    view.halfExtent = glm::vec2(std::tan(glm::radians(fovDeg) / 2.0f));
    return view;
}

// Orthographic, `half` metres to each side.
inline render::View parallelView(const glm::vec3& eye, const glm::vec3& target, float half) {
    render::View view = lookingAt(eye, target, 90.0f);
    view.halfExtent = glm::vec2(half);
    view.perspective = false;
    view.farM = 10.0f;
    return view;
}

inline render::Lighting litBy(const scene::Light& light) {
    render::Lighting lighting;
    lighting.lights = {light};
    lighting.rgb = {glm::vec3(1.0f)};
    lighting.referenceIrradiance = light.intensity;
    return lighting;
}

inline scene::Light spotAt(const glm::vec3& position, const glm::vec3& direction, float intensity) {
    scene::Light light;
    light.position = position;
    light.direction = glm::normalize(direction);
    light.intensity = intensity;
    light.innerConeDeg = light.outerConeDeg = 60.0f;
    return light;
}

inline scene::Material matte(const glm::vec3& albedo) {
    scene::Material material;
    material.baseColor = glm::vec4(albedo, 1.0f);
    return material;
}

inline scene::Material glass() {
    scene::Material material;
    material.caster = true;
    return material;
}

}  // namespace caustream::tests
