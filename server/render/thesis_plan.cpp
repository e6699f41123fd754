#include "render/thesis_plan.h"

#include <string>

#include "render/passes/photon_hierarchy.h"
#include "render/thesis_colours.h"

namespace caustream::render {

namespace {

// Which wavelengths, and why: the published algorithm has colours for 1, 7 or 21 of its own.
void chooseWavelengths(const PlanFacts& facts, const Request& request, RenderPlan& plan) {
    const Transport& transport = request.transport;
    const bool listed = !transport.wavelengthsNm.empty();
    const int asked = listed ? static_cast<int>(transport.wavelengthsNm.size()) : transport.wavelengths;
    if (!(facts.dispersive || transport.forceDispersive || request.wavelengthBands || listed)) {
        plan.wavelengths = 1;
        plan.wavelengthReason = "no glass disperses: one wavelength is white";
        return;
    }
    plan.wavelengths = listed ? asked : thesisWavelengthCount(asked);
    plan.wavelengthReason = listed ? "asked for"
                            : asked == plan.wavelengths ? "the published colours"
                            : asked == kContinuous ? "as published, which knows no continuous spectrum"
                            : "as published, which has 1, 7 or 21, not " + std::to_string(asked);
}

}  // namespace

RenderPlan makeThesisPlan(const PlanFacts& facts, const Request& request) {
    RenderPlan plan;
    chooseWavelengths(facts, request, plan);
    const auto add = [&](const char* pass, bool run, std::string reason) { plan.entries.push_back({pass, run, std::move(reason)}); };
    const auto light = [&](const char* pass, bool needed, const std::string& why, const std::string& whyNot) {
        if (!needed) add(pass, false, whyNot);
        else if (facts.lightCached) add(pass, false, "scene, light, materials and transport are unchanged");
        else add(pass, true, why);
    };
    const std::string noCaster = facts.idleCasters ? "every caster has the index of what is around it"
                                 : facts.thinWalled ? "thin-walled casters bend no light" : "no caster in the scene";
    const bool caustics = facts.casters > 0;
    const Transport& transport = request.transport;
    const int levels = hierarchyLevels(transport.photonGrid > 0 ? transport.photonGrid : kThesisGrid, transport.hierarchyLevels);
    light("receiver_depth", caustics || facts.shadowCasters,
          caustics ? "light lands behind the caster" : "something throws a shadow", "nothing throws a shadow");
    light("caster_layers", caustics, "a caster is in the light", noCaster);
    light("photon_hierarchy", caustics, std::to_string(levels) + " levels above the caster's image", noCaster);
    light("photon_splat", caustics,
          std::to_string(plan.wavelengths) + " wavelengths, " + plan.wavelengthReason +
              "; the published steps and splat: filter, back_steps and receiver_steps mean nothing here",
          noCaster);
    light("gap_fill", caustics && transport.gapFill && plan.wavelengths > 1 && !request.wavelengthBands, "asked for",
          transport.gapFill ? "one wavelength leaves no gaps" : "not asked for");

    plan.casters = facts.casters;
    plan.shadow = caustics || facts.shadowCasters;
    addCameraSide(plan, facts, request, caustics);
    for (PlanEntry& entry : plan.entries) {
        entry.without.clear();   // it leaves nothing out: whole images, every wavelength
        if (entry.pass == "camera_receivers") entry.pass = "thesis_receivers";
        if (entry.pass == "dispersive_refraction") entry.pass = "thesis_refraction";
    }
    return plan;
}

}  // namespace caustream::render
