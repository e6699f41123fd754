#include "session/scene_summary.h"

#include <utility>

#include "session/overloaded.h"

namespace caustream::session {
namespace {

protocol::Vec3 onTheWire(const glm::vec3& v) { return {v.x, v.y, v.z}; }

std::optional<protocol::Box> onTheWire(const scene::Bounds& bounds) {
    if (bounds.empty()) {
        return std::nullopt;
    }
    return protocol::Box{onTheWire(bounds.min), onTheWire(bounds.max)};
}

protocol::Spectrum onTheWire(const optics::Spectrum& spectrum) {
    return std::visit(
        Overloaded{[](const optics::EqualEnergy&) -> protocol::Spectrum { return protocol::EqualEnergy{}; },
                   [](const optics::DaylightD65&) -> protocol::Spectrum { return protocol::DaylightD65{}; },
                   [](const optics::Blackbody& b) -> protocol::Spectrum { return protocol::Blackbody{b.kelvin}; },
                   [](const optics::Lines& lines) -> protocol::Spectrum { return protocol::Lines{lines.nm}; }},
        spectrum);
}

protocol::LightState onTheWire(const scene::Light& light) {
    const bool directional = light.type == scene::LightType::Directional;
    protocol::LightState state;
    state.type = static_cast<protocol::LightType>(light.type);
    state.position = onTheWire(light.position);
    state.direction = onTheWire(light.direction);
    if (light.type == scene::LightType::Spot) {
        state.halfAngleDeg = light.outerConeDeg;
        state.innerAngleDeg = light.innerConeDeg;
    }
    state.intensity = {directional ? protocol::Intensity::Unit::Lux : protocol::Intensity::Unit::Candela, light.intensity};
    state.color = onTheWire(light.color);
    state.spectrum = onTheWire(light.spectrum);
    state.cookie = protocol::Cookie{};
    if (light.cookie >= 0) {
        state.cookie->texture = static_cast<std::uint32_t>(light.cookie);
    }
    return state;
}

}  // namespace

protocol::Dispersion onTheWire(const optics::Dispersion& dispersion) {
    return std::visit(
        Overloaded{[](const optics::ConstantIndex& c) -> protocol::Dispersion { return protocol::ConstantIndex{c.n}; },
                   [](const optics::Cauchy& c) -> protocol::Dispersion { return protocol::Cauchy{c.A, c.B_um2, c.C_um4}; },
                   [](const optics::Abbe& a) -> protocol::Dispersion { return protocol::Abbe{a.n_d, a.V_d}; },
                   [](const optics::Sellmeier& s) -> protocol::Dispersion { return protocol::Sellmeier{s.B, s.C_um2}; }},
        dispersion);
}

protocol::SceneSummary summarize(const scene::Scene& scene) {
    const scene::Geometry& geometry = *scene.geometry;
    protocol::SceneSummary summary;
    summary.name = scene.name;
    summary.bounds = onTheWire(geometry.bounds);
    summary.casterBounds = onTheWire(geometry.casterBounds);
    summary.triangles = static_cast<std::uint32_t>(geometry.indices.size() / 3);
    for (const scene::Object& object : geometry.objects) {
        const bool caster = scene.materials[static_cast<std::size_t>(object.material)].caster;
        (caster ? summary.casters : summary.receivers).push_back(object.name);
    }
    for (const scene::Material& material : scene.materials) {
        summary.materials.push_back({material.name, material.caster});
    }
    for (const scene::Light& light : scene.lights) {
        summary.lights.push_back({light.name, static_cast<protocol::LightType>(light.type)});
    }
    for (const scene::Camera& camera : scene.cameras) {
        summary.cameras.push_back(
            {camera.name, onTheWire(camera.eye), onTheWire(camera.target), onTheWire(camera.up), camera.fovYDeg});
    }
    summary.warnings = scene.warnings;
    return summary;
}

protocol::Json resolvedDocument(const protocol::State& state, const scene::Scene& resolved, const scene::Camera& camera) {
    protocol::State full = state;
    for (const scene::Light& light : resolved.lights) {
        full.lights[light.name] = onTheWire(light);
    }
    for (const scene::Material& material : resolved.materials) {
        if (material.caster) {
            protocol::MaterialState& shown = full.materials[material.name];
            shown.dispersion = onTheWire(material.dispersion);
            shown.absorption = protocol::Absorption{material.absorption.nm, material.absorption.perM};
        }
    }
    full.camera.eye = onTheWire(camera.eye);
    full.camera.target = onTheWire(camera.target);
    full.camera.up = onTheWire(camera.up);
    full.camera.fovYDeg = camera.fovYDeg;
    full.environmentColor = onTheWire(resolved.environmentColor);
    full.outsideIndex = resolved.outsideIndex;
    return protocol::toJson(full);
}

}  // namespace caustream::session
