#include "render/light_uniforms.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "render/coarse_trace.h"

namespace caustream::render {

float radianceUnit(const Lighting& lighting) {
    const float unit = lighting.referenceIrradiance / glm::pi<float>();
    return unit > 0.0f && std::isfinite(unit) ? unit : 1.0f;
}

float irradianceScale(const Lighting& lighting) { return 1.0f / (radianceUnit(lighting) * glm::pi<float>()); }

void setLight(const gl::Uniforms& uniforms, const std::string& name, const scene::Light& light, const glm::vec3& rgb) {
    const auto at = [&](const char* member) { return name + "." + member; };
    const bool spot = light.type == scene::LightType::Spot;
    const float inner = coneVersine(light.innerConeDeg), outer = coneVersine(light.outerConeDeg), ramp = outer - inner;
    uniforms.set(at("position").c_str(), light.position)
        .set(at("direction").c_str(), light.direction)
        .set(at("rgb").c_str(), rgb * light.intensity)
        .set(at("versineOuter").c_str(), spot ? outer : 4.0f)
        .set(at("coneScale").c_str(), spot ? (ramp > 1e-6f * outer ? 1.0f / ramp : 0.0f) : 1.0f)
        .set(at("directional").c_str(), light.type == scene::LightType::Directional);
}

}  // namespace caustream::render
