#include "render/pipeline.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <list>

#include "error.h"
#include "gl/context.h"
#include "render/camera_side.h"
#include "render/choose_mode.h"
#include "render/choose_transport.h"
#include "render/key_light.h"
#include "render/light_side.h"
#include "render/light_uniforms.h"
#include "render/map_energy.h"
#include "render/passes/camera_receivers.h"
#include "render/passes/gap_fill.h"
#include "render/passes/planar_yuv.h"
#include "render/passes/present.h"
#include "render/read_back.h"
#include "render/surface_labels.h"
#include "render/thesis_light_side.h"
#include "render/thesis_plan.h"
#include "render/traced_light_side.h"
#include "scene/builtin_scenes.h"
#include "shaders/shared/layout.h"

namespace caustream::render {

namespace {

constexpr std::size_t kMostLightMaps = 4;    // poses kept for one viewer, about 10 MB each at 512^2; one more for each other
constexpr int kSoftwareNodes = 4;            // of a continuous spectrum on software GL
constexpr std::size_t kMostChoices = 16;     // of budgets and targets, remembered so that they do not flicker
constexpr float kAutoKey = 0.8f;             // picture value of a white receiver that faces the light at the caustic

// Names of Target::Pass and what each shows.
const std::vector<std::string> kPassNames = {"caster_layers",    "receiver_depth", "shadow",
                                             "map_resolve",      "outer_map",      "camera_receivers",
                                             "camera_casters",   "dispersive_refraction", "camera_paths",
                                             "depth",            "normals",        "caster_mask"};

// Everything that the light's side depends on, byte by byte; equal keys mean equal maps.
class LightKey {
   public:
    template <class T>
    void add(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    template <class T>
    void addAll(const std::vector<T>& values) {
        add(values.size());
        for (const T& value : values) add(value);
    }
    const std::string& bytes() const { return bytes_; }

   private:
    std::string bytes_;
};

std::string lightKey(const Request& request, const scene::Light& light, int photonGrid) {
    LightKey key;
    key.add(request.scene->geometry.get());
    key.add(request.scene->outsideIndex);
    for (const scene::Material& material : request.scene->materials) {
        key.add(material.caster), key.add(material.thinWalled), key.add(material.mirror);
        if (!material.caster) continue;
        for (double nm = optics::kBandMinNm; nm <= optics::kBandMaxNm; nm += 50.0) {
            key.add(optics::refractiveIndex(material.dispersion, nm));
        }
        key.addAll(material.absorption.nm), key.addAll(material.absorption.perM);
    }
    key.add(light.type), key.add(light.position), key.add(light.direction);
    key.add(light.innerConeDeg), key.add(light.outerConeDeg), key.add(light.cookie);
    key.add(light.spectrum.index());
    for (double nm = optics::kBandMinNm; nm <= optics::kBandMaxNm; nm += 10.0) key.add(optics::relativePower(light.spectrum, nm));
    if (const auto* lines = std::get_if<optics::Lines>(&light.spectrum)) key.addAll(lines->nm);
    const Transport& t = request.transport;
    key.add(t.mode), key.add(t.hierarchyLevels), key.add(t.wavelengths), key.addAll(t.wavelengthsNm), key.add(photonGrid), key.add(t.backLayer), key.add(t.mapSize), key.add(t.backSteps);
    key.add(t.receiverSteps), key.add(t.gapFill), key.add(t.filter), key.add(t.forceDispersive), key.add(request.wavelengthBands);
    key.add(t.bounces), key.add(t.exactReceivers), key.add(request.observer), key.add(request.forced);
    return key.bytes();
}

View cameraView(const scene::Camera& camera, const scene::Scene& scene, int width, int height) {
    View view;
    const glm::vec3 towards = camera.target - camera.eye;
    const float distance = glm::length(towards);
    view.worldToView = lookAlong(camera.eye, distance > 0.0f ? towards / distance : glm::vec3(0, 0, -1), camera.up);
    const float tangent = std::tan(0.5f * glm::radians(camera.fovYDeg));
    view.halfExtent = glm::vec2(tangent * static_cast<float>(width) / static_cast<float>(height), tangent);
    // Of what the camera looks at, which may be small in a wide scene
    const float reach = std::max(scene.geometry->bounds.radius(), 1e-6f);
    view.nearM = 1e-3f * (distance > 0.0f ? std::clamp(distance, 1e-6f * reach, reach) : reach);
    view.farM = 1e6f * view.nearM;
    return view;
}

struct SceneEntry {
    explicit SceneEntry(const scene::Scene& scene) : gpu(scene.geometry), tracer(scene), enclosure(*scene.geometry), geometry(scene.geometry), casters(exactCasters(scene)) {}
    GpuScene gpu;
    CoarseTrace tracer;
    Enclosure enclosure;
    std::shared_ptr<const scene::Geometry> geometry;
    std::vector<ExactCaster> casters;         // of traced transport
    std::unique_ptr<ExactSurfaces> surfaces;  // made when first traced

    const ExactSurfaces& exact(const scene::Scene& scene) {
        if (!surfaces) surfaces = std::make_unique<ExactSurfaces>(scene);
        return *surfaces;
    }
};

// Whether a light key is one of this geometry's.
bool lightKeyOf(const std::string& key, const scene::Geometry* geometry) {
    return key.size() >= sizeof geometry && std::memcmp(key.data(), &geometry, sizeof geometry) == 0;
}

struct LightEntry {
    std::string key;
    LightMaps maps;
};

}  // namespace

struct Pipeline::Impl {
    gl::Context& context;
    gl::ShaderLibrary& shaders;
    gl::StageTimer timer;
    LightSide lightSide;
    ThesisLightSide thesisSide;
    TracedLightSide tracedSide;
    GapFill gapFill;
    CameraSide cameraSide;
    Present present;
    PlanarYuv planarYuv;
    SurfaceLabels labels;

    std::vector<std::unique_ptr<SceneEntry>> scenes;
    std::list<LightEntry> lights;              // newest first
    std::size_t viewers = 1;
    bool lightReused = false;                  // by the frame that is being drawn
    gl::Texture output;
    gl::Buffer planes;
    Calibration calibration;
    struct Chosen {
        const void* scene;
        double budgetMs, targetError;
        Configuration configuration;
    };
    std::list<Chosen> chosen;                  // newest first: what each scene and wish had last

    Impl(gl::Context& c, gl::ShaderLibrary& s)
        : context(c), shaders(s), timer(c.software()), lightSide(s), thesisSide(s), tracedSide(s), gapFill(s), cameraSide(s), present(s), planarYuv(s), labels(s) {
        glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);   // reversed depth, see view.h
    }

    SceneEntry& sceneEntry(const scene::Scene& scene);
    Request withChoice(const Request& request, const PlanFacts& facts, std::string& sentence);
    LightMaps& lightMaps(const Request& request, SceneEntry& entry, int key, Transport transport, RenderPlan& plan, PlanFacts facts);
    bool isKept(const std::string& lightPose) const {
        return std::any_of(lights.begin(), lights.end(), [&](const LightEntry& e) { return e.key == lightPose; });
    }
    void picture(const Request& request, LightMaps& maps, float scale);
    Frame label(const Request& request, const GpuScene& gpu, const View& view);
    void fillGaps(LightMaps& maps, bool tell);
    const gl::Texture& mapOf(LightMaps& maps, int size);
    void replaceMap(LightMaps& maps, const std::vector<float>& rgb);
};

// For a still it is told what that did to the map's light.
void Pipeline::Impl::fillGaps(LightMaps& maps, bool tell) {
    const double before = tell ? mapFlux(maps.map, maps.mapView) : 0.0;
    timer.stage("gap_fill", [&] { gapFill.run(maps.map); });
    if (before <= 0.0) return;
    char text[80];
    std::snprintf(text, sizeof text, "gap filling multiplied the map's energy by %.2f", mapFlux(maps.map, maps.mapView) / before);
    maps.warnings.push_back(text);
}

// The spectral map, black where no light gets through.
const gl::Texture& Pipeline::Impl::mapOf(LightMaps& maps, int size) {
    if (!maps.hasMap) {
        const float black[4] = {};
        maps.map.ensure(size, size, GL_RGBA32F, "spectral map");
        glClearTexImage(maps.map.get(), 0, GL_RGBA, GL_FLOAT, black);
    }
    return maps.map;
}

// The newest light pose's map with other light in it; its receivers stay, and no later frame takes it for its own.
void Pipeline::Impl::replaceMap(LightMaps& maps, const std::vector<float>& rgb) {
    std::vector<float> texels(rgb.size() / 3 * 4);
    glGetTextureImage(maps.map.get(), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(texels.size() * sizeof(float)), texels.data());
    for (std::size_t i = 0; i < rgb.size(); ++i) texels[i / 3 * 4 + i % 3] = rgb[i];
    glTextureSubImage2D(maps.map.get(), 0, 0, 0, maps.map.width(), maps.map.height(), GL_RGBA, GL_FLOAT, texels.data());
    lights.front().key.clear();
}

SceneEntry& Pipeline::Impl::sceneEntry(const scene::Scene& scene) {
    for (const auto& entry : scenes) {
        if (entry->geometry == scene.geometry) return *entry;
    }
    return *scenes.emplace_back(std::make_unique<SceneEntry>(scene));
}

// The request with the transport that meets its budget or target error, if it has one.
Request Pipeline::Impl::withChoice(const Request& request, const PlanFacts& facts, std::string& sentence) {
    Transport wanted = request.transport;
    if (wanted.budgetMs <= 0.0 && wanted.targetError <= 0.0) return request;
    if (wanted.mode == Mode::Traced) {
        sentence = wanted.budgetMs > 0.0 ? "as many photons a frame as half of the budget affords" : "the fewest photons, until the error is estimated below the target";
        return request;
    }
    if (wanted.mode != Mode::Refined) {
        sentence = "nothing: the published algorithm has no estimate to choose by";
        return request;
    }
    const void* scene = request.scene->geometry.get();
    const bool listed = !wanted.wavelengthsNm.empty(), keep = listed || request.wavelengthBands || facts.lines;
    if (listed) wanted.wavelengths = static_cast<int>(wanted.wavelengthsNm.size());
    const std::vector<Configuration> offers = paretoFront(
        calibration.configurations(scene, wanted, facts.dispersive, {.wavelengths = keep, .mapSize = request.target == Target::Spectral}));
    auto last = std::find_if(chosen.begin(), chosen.end(), [&](const Chosen& c) {
        return c.scene == scene && c.budgetMs == wanted.budgetMs && c.targetError == wanted.targetError;
    });
    const Choice choice = choose(offers, wanted, last == chosen.end() ? std::nullopt : std::optional(last->configuration));
    if (last == chosen.end()) last = chosen.insert(chosen.begin(), {scene, wanted.budgetMs, wanted.targetError, {}});
    last->configuration = choice.configuration;
    if (chosen.size() > kMostChoices) chosen.pop_back();

    sentence = choice.sentence;
    Request out = request;
    Transport& transport = out.transport;
    transport.budgetMs = transport.targetError = 0.0;
    transport.photonGrid = choice.configuration.photonGrid, transport.mapSize = choice.configuration.mapSize;
    transport.backSteps = choice.configuration.backSteps;
    if (!keep) transport.wavelengths = choice.configuration.wavelengths;
    return out;
}

LightMaps& Pipeline::Impl::lightMaps(const Request& request, SceneEntry& entry, int key, Transport transport,
                                     RenderPlan& plan, PlanFacts facts) {
    const scene::Light& light = request.scene->lights[static_cast<std::size_t>(key)];
    const std::string wanted = lightKey(request, light, transport.photonGrid);
    auto found = std::find_if(lights.begin(), lights.end(), [&](const LightEntry& e) { return e.key == wanted; });
    // The light's own images are not kept: looking at them means making them. So does a hash that was not taken.
    const bool shown = request.target == Target::Pass && (request.pass == "caster_layers" || request.pass == "receiver_depth");
    const bool traced = transport.mode == Mode::Traced, thesis = transport.mode == Mode::Thesis;
    const bool unhashed = request.still && found != lights.end() && found->maps.hasMap && found->maps.mapHash == 0;
    facts.lightCached = found != lights.end() && !shown && !request.countResiduals && (traced || !unhashed);
    facts.adding = facts.lightCached && request.converge && found->maps.convergence && !found->maps.convergence->converged;
    const auto conclude = [&](const LightMaps& maps) {
        facts.castersLit = maps.castersLit, facts.lands = maps.lands, facts.outerEmpty = maps.outerEmpty;
        const auto& objects = request.scene->geometry->objects;
        const auto receiversIn = [&](const View& view) {
            return static_cast<int>(std::count_if(objects.begin(), objects.end(), [&](const scene::Object& object) {
                return !request.scene->materials[static_cast<std::size_t>(object.material)].caster && inView(object, view);
            }));
        };
        if (maps.hasShadow) facts.receiversInShadow = receiversIn(maps.shadowView);
        if (maps.hasMap) facts.receiversInMap = receiversIn(maps.outerView);
        plan = makePlan(facts, request);
    };
    const bool again = request.forced.has(Omission::UnchangedLight);
    const auto inputs = [&] {
        return LightSide::Inputs{*request.scene, entry.gpu, entry.tracer, light, transport, plan, entry.enclosure, request.wavelengthBands,
                                 request.still, request.countResiduals, request.observer, request.forced};
    };
    lightReused = facts.lightCached && !again;
    if (lightReused) {
        lights.splice(lights.begin(), lights, found);
        LightMaps& maps = found->maps;
        conclude(maps);
        if (!traced || !maps.hasMap || request.wavelengthBands) return maps;
        const LightSide::Inputs in = inputs();
        const TracedLightSide::Inputs all{in, entry.exact(*request.scene), context.software()};
        if (facts.adding) tracedSide.add(all, timer, maps), tracedSide.collect(all, maps);
        else if (unhashed) tracedSide.complete(all, timer, maps);
        return maps;
    }
    plan = makePlan(facts, request);   // which wavelengths the light has to be fitted to
    if (found != lights.end()) {
        lights.splice(lights.begin(), lights, found);
    } else if (lights.size() < kMostLightMaps + viewers - 1) {
        lights.emplace_front();
    } else {
        lights.splice(lights.begin(), lights, std::prev(lights.end()));   // the oldest pose's images serve again
    }
    lights.front().key.clear();   // not valid until it is done
    LightMaps& maps = lights.front().maps;
    maps.error.reset();
    if (!traced) maps.convergence.reset(), maps.exact.reset();
    const LightSide::Inputs in = inputs();
    if (thesis) {
        thesisSide.run(in, timer, maps);
        maps.outerEmpty = false;
    } else if (traced) {
        const TracedLightSide::Inputs all{in, entry.exact(*request.scene), context.software()};
        const TracedLightSide::Fit fit = TracedLightSide::fit(all);
        facts.castersLit = maps.castersLit = static_cast<int>(fit.emitters.size());
        facts.lands = maps.lands = fit.views.has_value();
        plan = makePlan(facts, request);
        tracedSide.begin(all, fit, timer, maps);
        tracedSide.collect(all, maps);
    } else {
        const LightFit fit = LightSide::fit(in);
        facts.castersLit = maps.castersLit = static_cast<int>(fit.casters.size());
        facts.lands = maps.lands = fit.views.has_value();
        plan = makePlan(facts, request);
        lightSide.run(in, fit, timer, maps);
    }
    if (maps.hasMap && plan.runs("gap_fill")) fillGaps(maps, request.still);
    if (thesis) thesisSide.collect(maps);
    else if (!traced) lightSide.collect(maps);
    lights.front().key = wanted;
    conclude(maps);
    return maps;
}

// The image that the request asks for, in `output`, rows top to bottom.
void Pipeline::Impl::picture(const Request& request, LightMaps& maps, float scale) {
    const bool linear = request.target == Target::Composite && request.sample != Sample::U8;
    const ProgressivePicture::Shown shown = cameraSide.shown(linear);
    Present::Inputs in{.image = shown.image->get(), .mode = Present::Mode::Picture, .scale = scale * shown.gain,
                       .before = shown.before ? shown.before->get() : 0,
                       .resized = shown.before && (shown.before->width() != shown.image->width() || shown.before->height() != shown.image->height()),
                       .share = shown.share,
                       .downsample = shown.image->width() > request.width};
    if (request.target == Target::Spectral || request.pass == "map_resolve") in = {.image = mapOf(maps, request.transport.mapSize).get(), .mode = Present::Mode::Map};
    if (request.target == Target::Pass) {
        const bool thesis = request.transport.mode == Mode::Thesis;
        const gl::Texture& frontLayer = thesis ? thesisSide.frontLayer() : lightSide.frontLayer();
        const gl::Texture& receiverDepths = thesis ? thesisSide.receivers() : lightSide.receivers();
        if (request.pass == "caster_layers") in = {.image = frontLayer.get(), .mode = Present::Mode::Normals};
        if (request.pass == "receiver_depth") in = {.image = receiverDepths.get(), .mode = Present::Mode::Layer, .depthImage = true};
        if (request.pass == "shadow") in = {.image = maps.shadow.get(), .mode = Present::Mode::Layer, .depthImage = true};
        if (request.pass == "outer_map") in = {.image = maps.outerMap.get(), .mode = Present::Mode::Map};
        if (request.pass == "camera_casters") in = {.image = cameraSide.front().get(), .mode = Present::Mode::Normals};
    }
    if (linear) in.mode = Present::Mode::Linear;
    present.run(in, request.width, request.height, linear ? GL_RGBA32F : GL_RGBA8, {output});
}

// What the camera sees first: no light is traced for it.
Frame Pipeline::Impl::label(const Request& request, const GpuScene& gpu, const View& view) {
    Frame frame;
    frame.stats.plan = {{"first_surface", true, request.pass + " is shown alone", {}}};
    labels.run(request, gpu, view, timer, present, output, frame);
    if (frame.pixels.empty()) timer.stage("read_back", [&] { readImage(output, request.sample, frame); });
    for (const auto& row : timer.rows()) frame.stats.stages.push_back({row.name, row.ms});
    return frame;
}

Pipeline::Pipeline(gl::Context& context, gl::ShaderLibrary& shaders) : impl_(std::make_unique<Impl>(context, shaders)) {}
Pipeline::~Pipeline() = default;

void Pipeline::warmUp(const std::function<void(int, int)>& progress) {
    const auto report = [&](int done) {
        if (progress) progress(done, 4);
    };
    // Those for a light with a cookie and those of the published algorithm are compiled when one comes: few do.
    impl_->shaders.program("photon_list", {{"COOKIE", 0}});
    PhotonTrace::warmUp(impl_->shaders, impl_->context.software() ? kSoftwareNodes : layout::kMostNodes);
    for (const char* stem : {"caster_layers", "receiver_depth", "first_surface"}) impl_->shaders.program(stem);
    MapResolve::warmUp(impl_->shaders);
    SpectralStep::warmUp(impl_->shaders);
    for (const int columns : {0, 1}) impl_->shaders.program("gap_fill", {{"COLUMNS", columns}});
    report(1);
    impl_->cameraSide.warmUpReceivers();
    report(2);
    impl_->cameraSide.warmUpCasters();
    impl_->present.warmUp();
    impl_->planarYuv.warmUp();
    report(3);

    // Drivers finish a program when it is first used: one small frame uses them all.
    if (auto scene = scene::loadBuiltin("gem")) {
        Request request;
        request.scene = std::make_shared<const scene::Scene>(std::move(*scene));
        request.camera = request.scene->cameras.front();
        request.width = request.height = 64;
        request.transport.photonGrid = request.transport.mapSize = 64;
        run(request);
    }
    collect({}, {});
    impl_->calibration = {};   // what first frames take says nothing
    report(4);
}

Frame Pipeline::run(const Request& asked) {
    Impl& impl = *impl_;
    const auto start = std::chrono::steady_clock::now();
    if (asked.target == Target::Pass && std::find(kPassNames.begin(), kPassNames.end(), asked.pass) == kPassNames.end()) {
        throw Error("no pass \"" + asked.pass + "\" to show");
    }
    impl.timer.beginFrame();
    const scene::Scene& scene = *asked.scene;
    SceneEntry& entry = impl.sceneEntry(scene);
    const View view = cameraView(asked.camera, scene, asked.width, asked.height);
    if (isLabel(asked)) {
        Frame frame = impl.label(asked, entry.gpu, view);
        frame.stats.renderMs = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        return frame;
    }
    const int key = keyLight(scene);
    ModeChoice mode = chooseMode(asked, entry.casters);
    Request wanted = asked;
    // Light that was traced while all was at rest stays so while the camera alone moves.
    wanted.transport.mode = Mode::Traced;
    const bool resting = mode.traceAtRest && impl.isKept(lightKey(wanted, scene.lights[static_cast<std::size_t>(key)], wanted.transport.photonGrid));
    if (resting) mode.mode = Mode::Traced, mode.why = "the light has not moved since it was traced exactly";
    wanted.transport.mode = mode.mode;
    if (mode.mode != Mode::Traced && mode.traceAtRest) wanted.transport.targetError = 0.0;   // which is where it converges to
    PlanFacts facts = gatherFacts(wanted, scene.lights[static_cast<std::size_t>(key)], view, entry.enclosure);
    facts.continuousNodes = impl.context.software() ? kSoftwareNodes : layout::kMostNodes;
    Frame frame;
    facts.modeReason = mode.why, facts.refinedCamera = resting && !asked.still;
    const Request request = impl.withChoice(wanted, facts, frame.stats.choice);
    Transport transport = request.transport;
    if (transport.photonGrid == 0 && transport.mode != Mode::Traced) {
        transport.photonGrid = transport.mode == Mode::Thesis ? kThesisGrid : impl.context.software() ? 256 : 1024;
    }

    // Light's side, from the cache where nothing changed
    RenderPlan plan;
    LightMaps& maps = impl.lightMaps(request, entry, key, transport, plan, facts);
    if (request.spectralMap && maps.hasMap) impl.replaceMap(maps, *request.spectralMap);
    if (scene.lights.size() > 1) {
        frame.stats.warnings.push_back("several lights: \"" + scene.lights[static_cast<std::size_t>(key)].name +
                                       "\", the strongest, throws the caustic; the others light directly");
    }

    // Camera's side
    std::optional<glm::vec3> landing;
    if (maps.lands && scene.lights[static_cast<std::size_t>(key)].type != scene::LightType::Directional) {
        landing = maps.landing;
    }
    Lighting lighting = makeLighting(scene, key, landing);
    lighting.hasShadow = maps.hasShadow, lighting.shadowView = maps.shadowView, lighting.shadowDepth = maps.shadow.get();
    lighting.hasMap = maps.hasMap, lighting.hasOuterMap = !maps.outerEmpty, lighting.mapView = maps.mapView, lighting.outerView = maps.outerView;
    lighting.map = maps.map.get(), lighting.outerMap = maps.outerMap.get();
    const float unit = radianceUnit(lighting);
    const float scale = request.exposureEv ? std::exp2(*request.exposureEv) * unit : kAutoKey * std::exp2(scene.exposureBiasEv);
    frame.stats.exposureEv = std::log2(scale / unit);
    const int zoom = request.still && !plan.runs("picture_mean") ? 2 : 1;   // pictures that add up have their own anti-aliasing
    impl.cameraSide.run({request, entry.gpu, view, lighting, maps, plan, zoom * request.width, zoom * request.height,
                         plan.traced ? &entry.exact(scene) : nullptr, maps.convergence ? static_cast<double>(maps.convergence->photons) : 1.0, scale}, impl.timer);
    const bool floats = !plan.runs("present");
    if (!floats) impl.timer.stage("present", [&] { impl.picture(request, maps, request.sample == Sample::U8 ? scale : unit); });

    const bool planar = plan.runs("planar_yuv");
    if (planar) {
        impl.timer.stage("planar_yuv", [&] { impl.planarYuv.run(impl.output, request.pixels, {impl.planes}); });
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);   // planar_yuv -> read-back
    }

    // Read-back
    impl.timer.stage("read_back", [&] {
        if (planar) readPlanes(impl.planes, request.pixels, request.width, request.height, frame);
        else if (!floats && request.sample == Sample::U8 && request.pixels == PixelLayout::Rgbx) readRgbx(impl.output, frame);
        else if (!floats) readImage(impl.output, request.sample, frame);
        else if (request.wavelengthBands) {
            const std::vector<float>& bands = request.outerMap ? maps.outerBands : maps.bands;
            const auto count = maps.wavelengths.nm.size();
            if (bands.empty() && request.outerMap) throw Error("the outer map's bands are kept by traced transport alone");
            packBands(bands, request.outerMap ? static_cast<int>(std::lround(std::sqrt(bands.size() / count))) : request.transport.mapSize, static_cast<int>(count), request.sample, frame);
        } else if (request.outerMap && maps.hasMap) readImage(maps.outerMap, request.sample, frame);
        else readImage(impl.mapOf(maps, request.transport.mapSize), request.sample, frame);
    });
    frame.wavelengthsNm = maps.wavelengths.nm;
    frame.lightMatrix = (request.outerMap ? maps.outerView : maps.mapView).worldToClip();
    frame.mapHash = maps.mapHash;
    for (const auto& row : impl.timer.rows()) frame.stats.stages.push_back({row.name, row.ms});
    const bool traced = plan.runs("photon_trace");
    const bool addsUp = plan.runs("picture_mean");
    frame.stats.plan = std::move(plan.entries);
    frame.stats.ledger = maps.ledger;
    if (request.countResiduals) frame.stats.residuals = maps.residuals;
    frame.stats.error = maps.error;
    frame.stats.convergence = maps.convergence;
    if (mode.mode != Mode::Traced && mode.traceAtRest && maps.hasMap && !request.wavelengthBands) {
        frame.stats.convergence = Convergence{.error = maps.error ? maps.error->total : 1.0, .target = targetOf(asked.transport)};
    }
    if (request.target == Target::Composite && frame.stats.convergence) {
        // The picture has to be there, too: its samples, and the passage from the moving one.
        const double picture = addsUp ? impl.cameraSide.progress().progress() : request.converge ? 1.0 : 0.0;
        frame.stats.convergence->converged = frame.stats.convergence->converged && picture >= 1.0;
        frame.stats.convergence->progress = std::min(frame.stats.convergence->progress, picture);
    }
    frame.stats.photons = maps.photons;
    frame.stats.lightReused = impl.lightReused;
    frame.stats.warnings.insert(frame.stats.warnings.end(), maps.warnings.begin(), maps.warnings.end());
    frame.stats.renderMs = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    if (!request.still && !request.wavelengthBands && !request.countResiduals && transport.mode == Mode::Refined) {
        transport.wavelengths = plan.continuous ? kContinuous : plan.wavelengths;
        impl.calibration.learnCost(transport, frame.stats, traced);
        if (traced && maps.error) impl.calibration.learnError(scene.geometry.get(), transport, *maps.error, maps.photons);
    }
    if (glGetError() == GL_OUT_OF_MEMORY) throw OutOfMemory("the GPU is out of memory; ask for a smaller picture, map or photon grid");
    return frame;
}

PixelLayout Pipeline::jpegPixels(bool halfChroma) const {
    if (impl_->context.software()) return PixelLayout::Rgbx;   // here read-back is a copy in memory, and libjpeg converts faster
    return halfChroma ? PixelLayout::Yuv420 : PixelLayout::Yuv444;
}

void Pipeline::collect(std::span<const scene::Geometry* const> shown, std::span<const std::uint64_t> viewers) {
    impl_->cameraSide.keepOnly(viewers);
    impl_->viewers = std::max<std::size_t>(viewers.size(), 1);
    while (impl_->lights.size() >= kMostLightMaps + impl_->viewers) impl_->lights.pop_back();
    std::vector<const scene::Geometry*> gone;
    std::erase_if(impl_->scenes, [&](const auto& entry) {
        const scene::Geometry* geometry = entry->geometry.get();
        if (std::ranges::find(shown, geometry) != shown.end()) return false;
        gone.push_back(geometry);
        return true;
    });
    if (gone.empty()) return;
    // Their light maps, too: a key begins with the geometry's address, which may come again.
    std::erase_if(impl_->lights, [&](const LightEntry& light) {
        return std::ranges::any_of(gone, [&](const scene::Geometry* geometry) { return lightKeyOf(light.key, geometry); });
    });
    impl_->chosen.clear();
}

std::span<const std::string> passNames() { return kPassNames; }

}  // namespace caustream::render
