#include "render/plan.h"

#include <algorithm>
#include <cmath>

#include "render/thesis_plan.h"

namespace caustream::render {

bool RenderPlan::runs(const std::string& pass) const {
    return std::any_of(entries.begin(), entries.end(), [&](const PlanEntry& entry) { return entry.pass == pass && entry.run; });
}

RenderPlan makePlan(const PlanFacts& facts, const Request& request) {
    if (request.transport.mode == Mode::Thesis) return makeThesisPlan(facts, request);
    RenderPlan plan;
    const Transport& transport = request.transport;
    const int asked = !transport.wavelengthsNm.empty() ? static_cast<int>(transport.wavelengthsNm.size())
                      : transport.wavelengths == kContinuous ? 7 : transport.wavelengths;
    if (facts.dispersive || transport.forceDispersive || request.wavelengthBands || !transport.wavelengthsNm.empty()) {
        plan.wavelengths = asked;
        plan.wavelengthReason = facts.dispersive ? "the glass disperses" : "asked for";
    } else {
        plan.wavelengths = 1;
        plan.wavelengthReason = "no glass disperses: one wavelength is white";
    }

    const auto add = [&](const char* pass, bool run, std::string reason) { plan.entries.push_back({pass, run, std::move(reason)}); };
    const std::string noCaster = facts.idleCasters ? "every caster has the index of what is around it"
                                 : facts.thinWalled ? "thin-walled casters bend no light" : "no caster in the scene";
    const auto light = [&](const char* pass, bool needed, const std::string& why, const std::string& whyNot) {
        if (!needed) add(pass, false, whyNot);
        else if (facts.lightCached) add(pass, false, "scene, light, materials and transport are unchanged");
        else add(pass, true, why);
    };
    const bool caustics = facts.casters > 0;
    light("caster_layers", caustics, "a caster is in the light", noCaster);
    light("photon_list", caustics, "a caster is in the light", noCaster);
    light("receiver_depth", caustics || facts.shadowCasters,
          caustics ? "light lands behind the caster" : "something throws a shadow", "nothing throws a shadow");
    light("photon_trace", caustics, std::to_string(plan.wavelengths) + " wavelengths: " + plan.wavelengthReason, noCaster);
    light("map_resolve", caustics && !request.wavelengthBands, "photons were traced",
          caustics ? "the bands are sent as they are" : noCaster);
    light("gap_fill", caustics && transport.gapFill && plan.wavelengths > 1 && !request.wavelengthBands, "asked for",
          transport.gapFill ? "one wavelength leaves no gaps" : "not asked for");

    const bool picture = request.target != Target::Spectral;
    const std::string noPicture = "the spectral map is sent, not a picture";
    add("camera_receivers", picture, picture ? "a picture is wanted" : noPicture);
    const bool glass = picture && facts.castersInCamera;
    const std::string noGlass = picture ? "no caster is in the camera's view" : noPicture;
    add("camera_casters", glass, glass ? "a caster is in the camera's view" : noGlass);
    add("dispersive_refraction", glass, glass ? "a caster is in the camera's view" : noGlass);
    add("present", picture, picture ? "a picture is wanted" : noPicture);
    return plan;
}

bool refracts(const scene::Material& material, double outsideIndex) {
    if (!material.caster || material.thinWalled) return false;
    if (!material.absorption.empty()) return true;
    for (const double nm : {optics::kBandMinNm, 587.56, optics::kBandMaxNm}) {
        if (std::abs(optics::refractiveIndex(material.dispersion, nm) - outsideIndex) > 1e-6) return true;
    }
    return false;
}

}  // namespace caustream::render
