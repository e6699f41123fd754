#include "render/traced_plan.h"

#include <string>

namespace caustream::render {

namespace {

constexpr int kFewTriangles = 64;   // are met sooner than the map's view is searched: 40% of photon_paths for the gem's floor

}  // namespace

RenderPlan makeTracedPlan(const PlanFacts& facts, const Request& request) {
    RenderPlan plan;
    plan.traced = !facts.refinedCamera;
    plan.casters = facts.casters + facts.mirrors;
    chooseWavelengths(plan, facts, request);
    const Transport& transport = request.transport;
    const bool caustics = plan.casters > 0 && facts.castersLit > 0 && facts.lands;
    PlanFacts thrown = facts;
    thrown.casters = plan.casters;
    const std::string none = whyNoCaustic(thrown);
    plan.shadow = caustics || facts.shadowCasters;
    plan.exactReceivers = transport.exactReceivers || facts.shadowCasters || facts.receiverTriangles <= kFewTriangles;
    plan.hidden = facts.shadowCasters || request.forced.has(Omission::Walls);

    const auto light = [&](const char* pass, bool needed, bool again, const std::string& why, const std::string& whyNot, std::vector<std::string> without = {}) {
        const bool run = needed && (!facts.lightCached || again);
        plan.entries.push_back({pass, run, run ? why : needed ? "scene, light, materials and transport are unchanged" : whyNot,
                                run ? std::move(without) : std::vector<std::string>{}});
    };
    const std::string mode = facts.modeReason.empty() ? "asked for" : facts.modeReason;
    std::vector<std::string> paths;
    if (!facts.cookie) paths.push_back("a cookie: the light has none");
    if (!plan.exactReceivers) paths.push_back("receivers triangle by triangle: none can stand before a caster, and the map's view has them");
    else if (!plan.hidden) paths.push_back("whether the light sees where it lands: no receiver hides another");
    if (!request.wavelengthBands) paths.push_back("bands: colours are asked for");
    light("receiver_depth", caustics || plan.shadow, false, caustics ? "light lands behind a caster" : "a receiver throws a shadow", "nothing throws a shadow");
    light("photon_paths", caustics, facts.adding,
          (facts.adding ? "adds photons: " : "traced exactly: ") + mode + "; " + std::to_string(plan.wavelengths) + " wavelengths" +
              (plan.continuous ? " and the spectrum between them: " : ": ") + plan.wavelengthReason, none, std::move(paths));
    const std::string bands = "the bands are sent as they are";
    const bool summed = caustics && !request.wavelengthBands;
    light("map_adapt", summed, facts.adding, transport.filter ? "sharp where photons are dense, spread where they are sparse" : "the filter is off: all stays sharp",
          caustics ? bands : none);
    light("map_resolve", summed, facts.adding, "photons were traced", caustics ? bands : none);
    addCameraSide(plan, facts, request, summed);
    return plan;
}

}  // namespace caustream::render
