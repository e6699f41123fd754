#include "render/key_light.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "optics/colour.h"

namespace caustream::render {

namespace {

constexpr glm::vec3 kLuminance(0.2126f, 0.7152f, 0.0722f);   // BT.709

glm::vec3 centreOfInterest(const scene::Scene& scene) {
    const scene::Bounds& casters = scene.geometry->casterBounds;
    return casters.empty() ? scene.geometry->bounds.centre() : casters.centre();
}

// lx (or W m^-2) on a surface at `point` that faces the light, on the light's axis.
float irradiance(const scene::Light& light, const glm::vec3& point) {
    const float strength = light.intensity * glm::dot(light.color, kLuminance);
    if (light.type == scene::LightType::Directional) return strength;
    const glm::vec3 away = point - light.position;
    return strength / std::max(glm::dot(away, away), 1e-12f);
}

float irradianceInCone(const scene::Light& light, const glm::vec3& point) {
    if (light.type == scene::LightType::Directional) return irradiance(light, point);
    const glm::vec3 away = point - light.position;
    return irradiance(light, point) * coneFalloff(light, away / std::max(glm::length(away), 1e-12f));
}

}  // namespace

int keyLight(const scene::Scene& scene) {
    const glm::vec3 centre = centreOfInterest(scene);
    int best = 0;
    float most = -1.0f;
    for (int i = 0; i < static_cast<int>(scene.lights.size()); ++i) {
        // A light that misses the casters can still be the key when no other reaches them.
        const scene::Light& light = scene.lights[static_cast<std::size_t>(i)];
        const float strength = irradianceInCone(light, centre) + 1e-6f * irradiance(light, centre);
        if (strength > most) most = strength, best = i;
    }
    return best;
}

Lighting makeLighting(const scene::Scene& scene, int key, const std::optional<glm::vec3>& landing) {
    Lighting lighting;
    const auto add = [&](const scene::Light& light) {
        lighting.lights.push_back(light);
        lighting.rgb.push_back(glm::vec3(optics::sampleWavelengths(7, light.spectrum).lightRgb) * light.color);
    };
    add(scene.lights[static_cast<std::size_t>(key)]);
    for (int i = 0; i < static_cast<int>(scene.lights.size()); ++i) {
        if (i != key) add(scene.lights[static_cast<std::size_t>(i)]);
    }
    lighting.keyRgb = lighting.rgb.front();

    const glm::vec3 point = landing.value_or(centreOfInterest(scene));
    float reference = irradiance(lighting.lights.front(), point);
    for (std::size_t i = 1; i < lighting.lights.size(); ++i) reference += irradianceInCone(lighting.lights[i], point);
    lighting.referenceIrradiance = std::max(reference, 1e-12f);
    lighting.environmentRadiance = scene.environmentColor * lighting.referenceIrradiance / glm::pi<float>();
    return lighting;
}

}  // namespace caustream::render
