#include "render/plan.h"

#include <algorithm>
#include <cmath>

#include "render/thesis_plan.h"
#include "render/traced_plan.h"

namespace caustream::render {

namespace {

using Without = std::vector<std::string>;

std::string counted(int count, const char* one) { return std::to_string(count) + " " + one + (count == 1 ? "" : "s"); }

// Which of the camera's passes the request's target needs.
struct Shown {
    bool receivers = true, casters = true, refraction = true, present = true;
    std::string why = "a picture is wanted", whyNot;
};

Shown shownBy(const Request& request) {
    Shown shown;
    if (request.target == Target::Spectral) {
        shown.receivers = shown.casters = shown.refraction = false;
        shown.present = request.sample == Sample::U8;
        shown.why = "the spectral map is shown as a picture";
        shown.whyNot = shown.present ? shown.why : "the spectral map is sent, not a picture";
    } else if (request.target == Target::Pass) {
        const bool refraction = request.pass == "dispersive_refraction" || request.pass == "camera_paths";
        const bool casters = request.pass == "camera_casters";
        shown.refraction = refraction;
        shown.casters = refraction || casters;
        shown.receivers = refraction || request.pass == "camera_receivers";
        shown.why = shown.whyNot = request.pass + " is shown alone";
    }
    return shown;
}

// Adds the rows of one plan.
class Rows {
   public:
    Rows(RenderPlan& plan, const PlanFacts& facts, const Request& request) : plan_(plan), facts_(facts), request_(request) {}

    void add(const char* pass, bool run, const std::string& why, const std::string& whyNot, Without without = {}) {
        plan_.entries.push_back({pass, run, run ? why : whyNot, run ? std::move(without) : Without{}});
    }
    // A pass of the light's side, whose result is kept.
    void light(const char* pass, bool needed, const std::string& why, const std::string& whyNot, Without without = {}) {
        const bool cached = facts_.lightCached && !request_.forced.has(Omission::UnchangedLight);
        add(pass, needed && !cached, why, needed ? "scene, light, materials and transport are unchanged" : whyNot, std::move(without));
    }

   private:
    RenderPlan& plan_;
    const PlanFacts& facts_;
    const Request& request_;
};

// Whether there is a caustic.
bool addLightSide(RenderPlan& plan, const PlanFacts& facts, const Request& request) {
    Rows rows(plan, facts, request);
    const Transport& transport = request.transport;
    const bool lands = facts.casters > 0 && facts.castersLit > 0 && facts.lands;
    const bool caustics = lands || request.forced.has(Omission::UnlitGlass);
    const std::string none = whyNoCaustic(facts), lit = lands ? counted(facts.castersLit, "caster") + " in the light" : "forced";
    plan.shadow = (facts.casters > 0 && facts.castersLit > 0) || facts.shadowCasters || request.forced.has(Omission::NoShadow);

    Without unlit, shadowOrMap, trace, levels;
    if (facts.castersLit < facts.casters) unlit.push_back(counted(facts.casters - facts.castersLit, "caster") + " outside the light");
    if (!caustics) shadowOrMap.push_back("the maps' views: " + none);
    if (!plan.shadow) shadowOrMap.push_back("the shadow: nothing throws one");
    const std::string walls = counted(facts.walls, "receiver") + " that can shade nothing";
    if (plan.shadow && facts.walls > 0) shadowOrMap.push_back(walls + ", in the shadow");
    if (facts.walls > 0) unlit.push_back(walls);
    const std::string cookie = "a cookie: the light has none";
    if (plan.wavelengths == 1) trace.push_back("steps between wavelengths: there is one");
    if (!transport.filter) levels.push_back("the pyramid: the filter is off");
    if (!facts.cookie) trace.push_back(cookie);
    trace.insert(trace.end(), levels.begin(), levels.end());
    if (!request.wavelengthBands) trace.push_back("bands: colours are asked for");

    rows.light("caster_layers", caustics, lit, none, unlit);
    rows.light("photon_list", caustics, lit, none, facts.cookie ? Without{} : Without{cookie});
    rows.light("receiver_depth", caustics || plan.shadow, caustics ? "light lands behind a caster" : "a receiver throws a shadow",
               "nothing throws a shadow", shadowOrMap);
    rows.light("photon_trace", caustics, counted(plan.wavelengths, "wavelength") + (plan.continuous ? " and the spectrum between them: " : ": ") + plan.wavelengthReason, none, trace);
    rows.light("map_resolve", caustics && !request.wavelengthBands, "photons were traced",
               caustics ? "the bands are sent as they are" : none, levels);
    rows.light("spectral_step", caustics && facts.dispersive && !facts.lines && !request.wavelengthBands,
               "what lies between the wavelengths is part of the error",
               !caustics ? none : !facts.dispersive ? "no glass disperses"
               : facts.lines ? "the light's lines are traced exactly" : "the bands are sent as they are");
    rows.light("gap_fill", caustics && transport.gapFill && plan.wavelengths > 1 && !request.wavelengthBands, "asked for",
               !transport.gapFill ? "not asked for" : !caustics ? none
               : request.wavelengthBands ? "the bands are sent as they are" : "one wavelength leaves no gaps");
    return caustics;
}

}  // namespace

std::string whyNoCaustic(const PlanFacts& facts) {
    if (facts.casters == 0) {
        return facts.idleCasters ? "every caster has the index of what is around it"
               : facts.thinWalled ? "thin-walled casters bend no light" : "no caster in the scene";
    }
    return facts.castersLit == 0 ? "the light reaches no caster" : "no light that passes a caster lands on a receiver";
}

void chooseWavelengths(RenderPlan& plan, const PlanFacts& facts, const Request& request) {
    const Transport& transport = request.transport;
    const bool continuous = transport.wavelengthsNm.empty() && transport.wavelengths == kContinuous;
    const int asked = !transport.wavelengthsNm.empty() ? static_cast<int>(transport.wavelengthsNm.size())
                      : !continuous ? transport.wavelengths
                      : request.wavelengthBands ? kContinuousBands : facts.continuousNodes;
    const bool forced = transport.forceDispersive || request.forced.has(Omission::Colours);
    if (facts.dispersive || forced || request.wavelengthBands || !transport.wavelengthsNm.empty()) {
        plan.wavelengths = asked;
        plan.continuous = continuous && !request.wavelengthBands;
        plan.wavelengthReason = facts.dispersive ? "the glass disperses" : "asked for";
    } else {
        plan.wavelengths = 1;
        plan.wavelengthReason = "no glass disperses: one is white";
    }
}

bool RenderPlan::runs(const std::string& pass) const {
    return std::any_of(entries.begin(), entries.end(), [&](const PlanEntry& entry) { return entry.pass == pass && entry.run; });
}

void addCameraSide(RenderPlan& plan, const PlanFacts& facts, const Request& request, bool caustics) {
    Rows rows(plan, facts, request);
    const Shown shown = shownBy(request);
    const bool forced = request.forced.has(Omission::Picture);

    Without receivers;
    if (!facts.receiversTextured) receivers.push_back("textures: no receiver has one");
    if (!facts.receiversGlossy && !facts.cookie && facts.lights == 1) receivers.push_back("gloss, further lights and cookie: there are none");
    const auto lookup = [&](const char* of, bool exists, const std::string& whyNot, int seen) {
        if (!exists) receivers.push_back(std::string(of) + " lookups: " + whyNot);
        else if (seen < facts.receivers) {
            receivers.push_back(std::string(of) + " lookups on " + counted(facts.receivers - seen, "receiver") + ": outside its view");
        }
    };
    lookup("shadow", plan.shadow, "nothing throws one", facts.receiversInShadow);
    lookup("map", caustics, "no caustic", facts.receiversInMap);
    if (caustics && facts.outerEmpty) receivers.push_back("the outer map: all light landed in the inner one");
    rows.add("camera_receivers", shown.receivers || forced, shown.why, shown.whyNot, receivers);

    const bool inView = facts.castersInCamera || (request.forced.has(Omission::UnseenGlass) && facts.glass > 0);
    const std::string glass = counted(facts.glassInCamera, "caster") + " in the camera's view";
    const std::string noGlass = facts.glass == 0 ? "there is no glass to see" : "no caster is in the camera's view";
    Without box, optics;
    if (facts.glassInCamera < facts.glass) box.push_back(counted(facts.glass - facts.glassInCamera, "caster") + " outside the view");
    if (facts.boxShare < 0.995) box.push_back(std::to_string(100 - static_cast<int>(std::lround(100.0 * facts.boxShare))) + "% of the picture: outside the casters' boxes");
    if (plan.wavelengths == 1) optics.push_back("wavelengths between nodes: there is one");
    if (!facts.absorbing) optics.push_back("absorption: no glass absorbs");
    if (!request.still) optics.push_back("a ray for each node and sharp reflections: the picture moves");
    optics.insert(optics.end(), box.begin(), box.end());
    if (plan.traced) {
        const std::string thin = counted(facts.thinWalled, "thin-walled caster"), traced = "camera_paths draws the casters";
        const bool walls = inView && facts.thinWalled > 0;
        rows.add("camera_casters", (shown.casters || forced) && walls, thin, shown.casters ? traced : shown.whyNot, box);
        rows.add("dispersive_refraction", (shown.refraction || forced) && walls, thin, shown.refraction ? traced : shown.whyNot, box);
        Without paths;
        if (!request.still && !request.converge) paths.push_back("more than two bounces and three wavelengths a pixel: the picture moves");
        paths.insert(paths.end(), box.begin(), box.end());
        const bool mirrors = plan.casters > facts.casters;
        rows.add("camera_paths", (shown.refraction || forced) && (inView || mirrors), facts.glassInCamera ? glass : "mirrors",
                 shown.refraction ? noGlass : shown.whyNot, paths);
        rows.add("picture_mean", request.converge && request.target == Target::Composite, "nothing moves: pictures add up",
                 request.converge ? shown.whyNot : "the picture moves");
    } else {
        rows.add("camera_casters", (shown.casters || forced) && inView, glass, shown.casters ? noGlass : shown.whyNot, box);
        rows.add("dispersive_refraction", (shown.refraction || forced) && inView, glass, shown.refraction ? noGlass : shown.whyNot, optics);
    }
    rows.add("present", shown.present, shown.why, shown.whyNot, request.still ? Without{} : Without{"averaging of 4 pixels: the picture moves"});
    rows.add("planar_yuv", shown.present && request.sample == Sample::U8 && isPlanar(request.pixels), "a JPEG's planes are read back: fewer bytes",
             shown.present ? "the picture is read back as RGB" : shown.whyNot);
}

RenderPlan makePlan(const PlanFacts& facts, const Request& request) {
    if (request.transport.mode == Mode::Thesis) return makeThesisPlan(facts, request);
    if (request.transport.mode == Mode::Traced) return makeTracedPlan(facts, request);
    RenderPlan plan;
    plan.casters = facts.casters;
    chooseWavelengths(plan, facts, request);
    const bool caustics = addLightSide(plan, facts, request);
    addCameraSide(plan, facts, request, caustics && !request.wavelengthBands);
    return plan;
}

bool absorbs(const scene::Material& material) {
    return std::any_of(material.absorption.perM.begin(), material.absorption.perM.end(), [](double perM) { return perM > 0.0; });
}

bool refracts(const scene::Material& material, double outsideIndex) {
    if (!material.caster || material.thinWalled) return false;
    if (absorbs(material)) return true;
    for (const double nm : {optics::kBandMinNm, 587.56, optics::kBandMaxNm}) {
        if (std::abs(optics::refractiveIndex(material.dispersion, nm) - outsideIndex) > 1e-6) return true;
    }
    return false;
}

}  // namespace caustream::render
