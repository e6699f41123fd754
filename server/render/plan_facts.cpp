#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "render/passes/camera_casters.h"
#include "render/passes/camera_receivers.h"
#include "render/plan.h"

namespace caustream::render {

namespace {

// Whether all receivers lie in one plane: none can stand before another, nor before itself.
bool inOnePlane(const scene::Scene& scene) {
    const scene::Geometry& geometry = *scene.geometry;
    const float tolerance = 1e-5f * geometry.bounds.radius();
    glm::vec3 origin(0.0f), normal(0.0f);
    bool plane = false;
    for (const scene::Object& object : geometry.objects) {
        if (scene.materials[static_cast<std::size_t>(object.material)].caster) continue;
        for (std::uint32_t i = 0; i + 2 < object.indexCount; i += 3) {
            const auto corner = [&](std::uint32_t k) { return geometry.vertices[geometry.indices[object.firstIndex + i + k]].position; };
            const glm::vec3 a = corner(0), b = corner(1), c = corner(2);
            if (!plane) {
                const glm::vec3 across = glm::cross(b - a, c - a);
                if (!(glm::dot(across, across) > 0.0f)) continue;
                origin = a, normal = glm::normalize(across), plane = true;
            }
            for (const glm::vec3& point : {a, b, c}) {
                if (std::abs(glm::dot(point - origin, normal)) > tolerance) return false;
            }
        }
    }
    return true;
}

// Absorption that is the same all along the band takes light, but no colour.
bool coloured(const optics::Absorption& absorption) {
    return std::adjacent_find(absorption.perM.begin(), absorption.perM.end(), std::not_equal_to<>()) != absorption.perM.end();
}

}  // namespace

PlanFacts gatherFacts(const Request& request, const scene::Light& key, const View& camera) {
    PlanFacts facts;
    const scene::Scene& scene = *request.scene;
    double pixels = 0.0;
    for (const scene::Object& object : scene.geometry->objects) {
        const scene::Material& material = scene.materials[static_cast<std::size_t>(object.material)];
        if (!material.caster) {
            ++facts.receivers;
            facts.receiversTextured = facts.receiversTextured || material.baseColorTexture >= 0;
            facts.receiversGlossy = facts.receiversGlossy || glossy(material);
            continue;
        }
        const bool bends = refracts(material, scene.outsideIndex);
        facts.casters += bends;
        facts.thinWalled += material.thinWalled;
        facts.idleCasters += !bends && !material.thinWalled;
        facts.dispersive = facts.dispersive || (bends && (optics::isDispersive(material.dispersion) || coloured(material.absorption)));
        facts.absorbing = facts.absorbing || (bends && absorbs(material));
        if (!bends && !material.thinWalled) continue;
        const PixelBox box = projectedBox(object.bounds, camera, request.width, request.height);
        ++facts.glass;
        facts.glassInCamera += !box.empty();
        pixels += double(box.width) * double(box.height);
    }
    facts.castersLit = facts.casters;
    facts.shadowCasters = facts.receivers > 0 && !inOnePlane(scene);
    facts.receiversInShadow = facts.receiversInMap = facts.receivers;
    facts.cookie = key.cookie >= 0;
    facts.lines = std::holds_alternative<optics::Lines>(key.spectrum);
    facts.lights = static_cast<int>(scene.lights.size());
    facts.castersInCamera = facts.glassInCamera > 0;
    facts.boxShare = std::min(1.0, pixels / (double(request.width) * double(request.height)));
    return facts;
}

}  // namespace caustream::render
