#include "render/receiver_shading.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <string>

#include "render/light_uniforms.h"

namespace caustream::render {

namespace {

constexpr std::size_t kMaxLights = 8;  // u_lights of the shader
enum Unit : GLuint { kShadow, kMap, kOuterMap, kCookie };

// The square around the outer cone, which a cookie spans; upright in the world.
View cookieView(const scene::Light& light) {
    View view;
    view.worldToView = lookAlong(light.position, light.direction, glm::vec3(0, 1, 0));
    view.halfExtent = glm::vec2(std::tan(glm::radians(std::min(light.outerConeDeg, 89.0f))));
    return view;
}

}  // namespace

bool hasCookie(const Lighting& lighting) { return !lighting.lights.empty() && lighting.lights[0].cookie >= 0; }

ReceiverShading::ReceiverShading()
    : linear_(gl::makeSampler(GL_LINEAR, GL_CLAMP_TO_EDGE, "linear")), shadow_(gl::makeShadowSampler("shadow")) {}

void ReceiverShading::bind(const gl::Uniforms& uniforms, GLuint firstUnit, const GpuScene& scene, const Lighting& lighting,
                           const View& view) const {
    const float perUnit = 1.0f / radianceUnit(lighting);
    const int first = static_cast<int>(firstUnit);
    uniforms.set("u_eye", view.perspective ? glm::vec4(view.position(), 1.0f) : glm::vec4(-view.forward(), 0.0f))
        .set("u_environment", lighting.environmentRadiance * perUnit)
        .set("u_keyColour", lighting.keyRgb);
    setView(uniforms, "u_shadowView", lighting.shadowView);
    setView(uniforms, "u_mapView", lighting.mapView);
    uniforms.set("u_outerScale", lighting.mapView.halfExtent / lighting.outerView.halfExtent);
    uniforms.set("u_shadowDepth", first + int(kShadow)).set("u_map", first + int(kMap)).set("u_outerMap", first + int(kOuterMap));
    uniforms.set("u_cookie", first + int(kCookie));

    const std::size_t count = std::min(lighting.lights.size(), kMaxLights);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 rgb = i == 0 ? lighting.keyRgb : lighting.rgb[i];
        setLight(uniforms, "u_lights[" + std::to_string(i) + "]", lighting.lights[i], rgb * irradianceScale(lighting));
    }
    if (count == 0) uniforms.set("u_lights[0].rgb", glm::vec3(0.0f));
    uniforms.set("u_lightCount", static_cast<int>(count));
    uniforms.set("u_hasCookie", hasCookie(lighting));
    if (hasCookie(lighting)) setView(uniforms, "u_cookieView", cookieView(lighting.lights[0]));

    if (lighting.hasShadow) glBindTextureUnit(firstUnit + kShadow, lighting.shadowDepth);
    if (lighting.hasMap) {
        glBindTextureUnit(firstUnit + kMap, lighting.map);
        glBindTextureUnit(firstUnit + kOuterMap, lighting.outerMap);
    }
    if (hasCookie(lighting)) glBindTextureUnit(firstUnit + kCookie, scene.texture(lighting.lights[0].cookie));
    glBindSampler(firstUnit + kShadow, shadow_.get());
    for (const Unit unit : {kMap, kOuterMap, kCookie}) glBindSampler(firstUnit + unit, linear_.get());
}

void ReceiverShading::unbind(GLuint firstUnit) { glBindSamplers(firstUnit, kUnits, nullptr); }

}  // namespace caustream::render
