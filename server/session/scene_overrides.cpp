#include "session/scene_overrides.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "session/overloaded.h"

namespace caustream::session {
namespace {

using protocol::DecodeError;
using protocol::ErrorCode;
using Problem = std::optional<DecodeError>;

constexpr double kLumenPerWatt = 683.0;

DecodeError problem(ErrorCode code, std::string message, std::string field) {
    return {.code = code, .message = std::move(message), .field = std::move(field)};
}

glm::vec3 vec3(const protocol::Vec3& v) { return {v[0], v[1], v[2]}; }

template <typename Named>
std::string namesOf(const std::vector<Named>& things) {
    std::string names;
    for (const Named& thing : things) {
        names += (names.empty() ? "" : ", ") + thing.name;
    }
    return names.empty() ? "none" : names;
}

optics::Spectrum spectrumOf(const protocol::Spectrum& spectrum) {
    return std::visit(Overloaded{[](const protocol::EqualEnergy&) -> optics::Spectrum { return optics::EqualEnergy{}; },
                                 [](const protocol::DaylightD65&) -> optics::Spectrum { return optics::DaylightD65{}; },
                                 [](const protocol::Blackbody& b) -> optics::Spectrum { return optics::Blackbody{b.kelvin}; },
                                 [](const protocol::Lines& lines) -> optics::Spectrum { return optics::Lines{lines.nm}; }},
                      spectrum);
}

optics::Dispersion dispersionOf(const protocol::Dispersion& dispersion) {
    return std::visit(
        Overloaded{[](const protocol::ConstantIndex& c) -> optics::Dispersion { return optics::ConstantIndex{c.n}; },
                   [](const protocol::Cauchy& c) -> optics::Dispersion { return optics::Cauchy{c.A, c.B_um2, c.C_um4}; },
                   [](const protocol::Abbe& a) -> optics::Dispersion { return optics::Abbe{a.n_d, a.V_d}; },
                   [](const protocol::Sellmeier& s) -> optics::Dispersion { return optics::Sellmeier{s.B, s.C_um2}; }},
        dispersion);
}

Problem applyIntensity(scene::Light& light, const protocol::Intensity& intensity, const std::string& field) {
    using Unit = protocol::Intensity::Unit;
    const bool directional = light.type == scene::LightType::Directional;
    if (directional != (intensity.unit == Unit::Lux)) {
        return problem(ErrorCode::BadRequest,
                       directional ? "a directional light's intensity is given in lx" : "lx is for directional lights; use cd or W",
                       field);
    }
    double value = intensity.value;
    if (intensity.unit == Unit::Watt) {
        const double halfAngle = light.outerConeDeg * std::numbers::pi / 180.0;
        const double solidAngle =
            light.type == scene::LightType::Point ? 4.0 * std::numbers::pi : 2.0 * std::numbers::pi * (1.0 - std::cos(halfAngle));
        value *= kLumenPerWatt / solidAngle;
    }
    light.intensity = static_cast<float>(value);
    return {};
}

Problem applyCone(scene::Light& light, const protocol::LightState& wanted, const std::string& path) {
    if (wanted.halfAngleDeg) {
        // The file's falloff keeps its share of the cone unless the document sets it too.
        const float share = light.outerConeDeg > 0 ? light.innerConeDeg / light.outerConeDeg : 1.0f;
        light.outerConeDeg = static_cast<float>(*wanted.halfAngleDeg);
        light.innerConeDeg = share * light.outerConeDeg;
    }
    if (wanted.innerAngleDeg) {
        if (*wanted.innerAngleDeg > light.outerConeDeg) {
            return problem(ErrorCode::OutOfRange, "the inner cone is wider than the light's half_angle_deg",
                           path + ".inner_angle_deg");
        }
        light.innerConeDeg = static_cast<float>(*wanted.innerAngleDeg);
    }
    return {};
}

Problem applyLight(scene::Light& light, const protocol::LightState& wanted, std::size_t textures, const std::string& path) {
    if (wanted.type) {
        light.type = static_cast<scene::LightType>(*wanted.type);
    }
    if (wanted.position) {
        light.position = vec3(*wanted.position);
    }
    if (wanted.direction) {
        const glm::vec3 direction = vec3(*wanted.direction);
        if (!(glm::length(direction) > 1e-12f)) {
            return problem(ErrorCode::OutOfRange, "a direction has a length", path + ".direction");
        }
        light.direction = glm::normalize(direction);
    }
    if (Problem bad = applyCone(light, wanted, path)) {
        return bad;
    }
    if (wanted.intensity) {
        if (Problem bad = applyIntensity(light, *wanted.intensity, path + ".intensity")) {
            return bad;
        }
    }
    if (wanted.color) {
        light.color = vec3(*wanted.color);
    }
    if (wanted.spectrum) {
        light.spectrum = spectrumOf(*wanted.spectrum);
    }
    if (wanted.cookie) {
        if (wanted.cookie->texture && *wanted.cookie->texture >= textures) {
            return problem(ErrorCode::OutOfRange, "the scene has " + std::to_string(textures) + " textures", path + ".cookie");
        }
        light.cookie = wanted.cookie->texture ? static_cast<int>(*wanted.cookie->texture) : -1;
    }
    return {};
}

Problem applyMaterial(scene::Material& material, const protocol::MaterialState& wanted, const std::string& path) {
    if (!material.caster) {
        return problem(ErrorCode::BadRequest, "light does not go through this material: it has no dispersion or absorption", path);
    }
    if (wanted.dispersion) {
        material.dispersion = dispersionOf(*wanted.dispersion);
    }
    if (wanted.absorption) {
        material.absorption = {wanted.absorption->nm, wanted.absorption->perM};
    }
    return {};
}

}  // namespace

tl::expected<scene::Scene, DecodeError> withOverrides(const scene::Scene& base, const protocol::State& state) {
    scene::Scene scene = base;
    for (const auto& [name, wanted] : state.lights) {
        const auto light = std::ranges::find(scene.lights, name, &scene::Light::name);
        if (light == scene.lights.end()) {
            return tl::unexpected(problem(ErrorCode::BadRequest,
                                          "this scene has no light of this name; it has: " + namesOf(scene.lights), "lights." + name));
        }
        if (Problem bad = applyLight(*light, wanted, scene.geometry->textures.size(), "lights." + name)) {
            return tl::unexpected(*bad);
        }
    }
    for (const auto& [name, wanted] : state.materials) {
        const auto material = std::ranges::find(scene.materials, name, &scene::Material::name);
        if (material == scene.materials.end()) {
            return tl::unexpected(problem(ErrorCode::BadRequest,
                                          "this scene has no material of this name; it has: " + namesOf(scene.materials),
                                          "materials." + name));
        }
        if (Problem bad = applyMaterial(*material, wanted, "materials." + name)) {
            return tl::unexpected(*bad);
        }
    }
    if (state.environmentColor) {
        scene.environmentColor = vec3(*state.environmentColor);
    }
    if (state.outsideIndex) {
        scene.outsideIndex = *state.outsideIndex;
    }
    return scene;
}

tl::expected<scene::Camera, DecodeError> cameraOf(const scene::Scene& scene, const protocol::State& state) {
    scene::Camera camera = scene.cameras.front();
    const protocol::CameraState& wanted = state.camera;
    camera.eye = wanted.eye ? vec3(*wanted.eye) : camera.eye;
    camera.target = wanted.target ? vec3(*wanted.target) : camera.target;
    camera.up = wanted.up ? vec3(*wanted.up) : camera.up;
    camera.fovYDeg = wanted.fovYDeg ? static_cast<float>(*wanted.fovYDeg) : camera.fovYDeg;

    const glm::vec3 forward = camera.target - camera.eye;
    if (!(glm::length(forward) > 1e-6f)) {
        return tl::unexpected(problem(ErrorCode::OutOfRange, "the camera stands on its target", "camera.target"));
    }
    const glm::vec3 side = glm::cross(glm::normalize(forward), camera.up);
    if (!(glm::length(side) > 1e-6f * glm::length(camera.up))) {
        return tl::unexpected(problem(ErrorCode::OutOfRange, "up points along the line of sight", "camera.up"));
    }
    return camera;
}

}  // namespace caustream::session
