#include <algorithm>

#include "render/passes/camera_casters.h"
#include "render/passes/camera_receivers.h"
#include "render/plan.h"

namespace caustream::render {

namespace {

// Absorption that is the same all along the band takes light, but no colour.
bool coloured(const optics::Absorption& absorption) {
    return std::adjacent_find(absorption.perM.begin(), absorption.perM.end(), std::not_equal_to<>()) != absorption.perM.end();
}

}  // namespace

PlanFacts gatherFacts(const Request& request, const scene::Light& key, const View& camera, const Enclosure& enclosure) {
    PlanFacts facts;
    const scene::Scene& scene = *request.scene;
    double pixels = 0.0;
    for (const scene::Object& object : scene.geometry->objects) {
        const scene::Material& material = scene.materials[static_cast<std::size_t>(object.material)];
        facts.mirrors += material.mirror;
        if (!material.caster) {
            ++facts.receivers;
            facts.receiverTriangles += static_cast<int>(object.indexCount / 3);
            facts.walls += !enclosure.shades(object, key);
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
    facts.shadowCasters = facts.walls < facts.receivers;
    facts.receiversInShadow = facts.receiversInMap = facts.receivers;
    facts.cookie = key.cookie >= 0;
    facts.lines = std::holds_alternative<optics::Lines>(key.spectrum);
    facts.lights = static_cast<int>(scene.lights.size());
    facts.castersInCamera = facts.glassInCamera > 0;
    facts.boxShare = std::min(1.0, pixels / (double(request.width) * double(request.height)));
    return facts;
}

}  // namespace caustream::render
