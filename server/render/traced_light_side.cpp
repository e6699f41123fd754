#include "render/traced_light_side.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "render/error_estimate.h"
#include "render/map_energy.h"
#include "render/map_pyramid.h"

namespace caustream::render {

namespace {

constexpr double kLeftOutShares[] = {0.005, 0.02, 0.05, 0.1, 0.2, 0.3};   // of the flux: what the outer map takes
constexpr double kOuterWidth = 2.0;            // half as many texels a side; and light that spreads so far is smooth
constexpr int kCoarseGrid = 16;                // photons a side of the trace that the map's view is fitted to
constexpr int kSpectraSoftware = 4, kSpectraHardware = 8;   // of a continuous spectrum, wavelengths a photon
constexpr int kFirstSoftware = 128, kFirstHardware = 1024;  // photons a side of a light pose's first frame
constexpr double kStillTimes = 16.0;           // as many photons for a still, where planes make them cheap
constexpr std::uint64_t kMostAtOnce = 1u << 18;             // photons of a dispatch: drivers watch how long one takes
// Of a dispatch: the least that GL 4.5 lets a driver take, 65,535 groups. Beyond, nothing at all would be traced.
constexpr std::uint64_t kMostThreads = 65535ull * layout::kGroupSize;
constexpr double kAddMs = 35.0;                // of a frame that adds photons, for the photons alone: ten frames a second remain
constexpr double kMilestone = 1.25;            // times as many photons until it is next asked whether that is enough
constexpr double kTarget = 0.01;               // relative L1, unless asked for
constexpr double kLeastMet = 1.0 / 16.0;       // of the photons: no more are sent out to hit a caster that fills less of its view
constexpr double kEnough = 4.0;                // photons that keep four texels sharp
constexpr double kPhotonUnits = 1048576.0;     // of the map for one photon of full flux: 2^44 of them fit 64 bits

std::uint64_t nowNs() {
    return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
}

// What bounces about lands far and wide: more than an afterthought.
int outerSizeOf(const Transport& transport) { return std::max(transport.mapSize / 32 * 16, 64); }

int levelsOf(const Transport& transport) { return transport.filter ? layout::kMostLevels : 1; }

std::size_t texelsOf(int size) { return static_cast<std::size_t>(size) * static_cast<std::size_t>(size); }

void clear(const gl::Buffer& buffer) { glClearNamedBufferData(buffer.get(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr); }

double wide(const GLuint* words) { return std::ldexp(static_cast<double>(words[1]), 32) + static_cast<double>(words[0]); }

}  // namespace

double targetOf(const Transport& transport) { return transport.targetError > 0.0 ? transport.targetError : kTarget; }

// As many that meet a caster as a square of that side has, or what half of a budget affords.
std::uint64_t TracedLightSide::firstPhotons(const Inputs& in, double met) const {
    const Transport& transport = in.light.transport;
    if (transport.photonGrid == 0 && transport.budgetMs > 0.0 && msPerPhoton_ > 0.0) {
        return static_cast<std::uint64_t>(std::clamp(0.5 * transport.budgetMs / msPerPhoton_, 1024.0, 1048576.0));
    }
    const double grid = transport.photonGrid > 0 ? transport.photonGrid : in.software ? kFirstSoftware : kFirstHardware;
    const double times = in.light.hash && transport.photonGrid == 0 && in.surfaces.convexOnly() ? kStillTimes : 1.0;
    return static_cast<std::uint64_t>(std::ceil(times * grid * grid / met));
}

TracedLightSide::Fit TracedLightSide::fit(const Inputs& all) {
    const LightSide::Inputs& in = all.light;
    Fit fit;
    const optics::WavelengthSet set = wavelengthsOf(in);
    std::vector<double> coarse{set.nm.front()};
    if (set.nm.size() > 2) coarse.push_back(set.nm[set.nm.size() / 2]);   // through a slit the middle may go alone
    if (set.nm.size() > 1) coarse.push_back(set.nm.back());
    std::vector<Landing> landings;
    double met = 0.0, sent = 0.0;
    const auto& casters = all.surfaces.casters();
    for (std::size_t c = 0; c < casters.size(); ++c) {
        const auto emission = emissionView(in.scene, in.light, in.scene.geometry->objects[casters[c].object]);
        if (!emission) continue;
        const double extent = 4.0 * static_cast<double>(emission->halfExtent.x) * static_cast<double>(emission->halfExtent.y);
        const CoarseTrace::Paths paths = in.tracer.paths(in.scene, in.light, casters, c, *emission, kCoarseGrid, coarse, in.transport.bounces);
        for (const Landing& landing : paths.landings) landings.push_back({landing.position, landing.flux * static_cast<float>(extent)});
        met += extent * paths.met, sent += extent;
        fit.emitters.push_back({static_cast<int>(c), *emission, extent});
    }
    if (sent > 0.0) fit.met = std::clamp(met / sent, kLeastMet, 1.0);
    if (!fit.emitters.empty()) fit.views = mapViews(in.scene, in.light, landings, kLeftOutShares, kOuterWidth);
    return fit;
}

void TracedLightSide::begin(const Inputs& all, const Fit& fit, gl::StageTimer& timer, LightMaps& out) {
    const LightSide::Inputs& in = all.light;
    out.hasMap = false;
    out.bands.clear();
    out.warnings.clear();
    out.ledger = {};
    out.residuals.reset();
    out.error.reset();
    out.convergence.reset();
    out.photons = 0;
    out.mapHash = 0;
    out.outerEmpty = false;
    tracedNow_ = 0;
    out.wavelengths = wavelengthsOf(in);
    out.seen = seenWavelengths(in, out.wavelengths);
    out.hasShadow = in.plan.shadow;
    if (out.hasShadow) {
        out.shadowView = shadowView(in.scene, in.light);
        timer.stage("receiver_depth", [&] {
            receiverDepth_.run({in.gpu, in.scene.materials, out.shadowView, kShadowSize, true, in.scene.outsideIndex,
                                [&](const scene::Object& object) { return shadesNothing(in, object); }}, out.shadow);
        });
    }
    if (!in.plan.runs("photon_paths")) return;
    if (fit.emitters.empty()) {
        out.warnings.push_back("the light \"" + in.light.name + "\" reaches no caster: aim it at one");
    } else if (!fit.views) {
        out.warnings.push_back("no light that passes a caster lands on a receiver: no caustic to show");
    }
    const MapViews views = fit.views.value_or(MapViews{shadowView(in.scene, in.light), shadowView(in.scene, in.light), {}});
    out.mapView = views.inner, out.outerView = views.outer, out.landing = views.landing;

    if (!out.exact) out.exact = std::make_shared<ExactSums>();
    ExactSums& sums = *out.exact;
    sums.emitters = fit.emitters;
    sums.extent = 0.0;
    for (const ExactEmitter& emitter : sums.emitters) sums.extent += emitter.extent;
    sums.photons = 0, sums.met = fit.met, sums.milestone = firstPhotons(all, fit.met);
    sums.ledger.fill(0.0);
    sums.entries = spectralEntries(out.wavelengths);
    sums.table.fill(in.scene, all.surfaces.casters(), sums.entries);
    sums.spectra = sums.entries.continuous ? (all.software ? kSpectraSoftware : kSpectraHardware) : static_cast<int>(sums.entries.nm.size());
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& xyz : out.wavelengths.xyz) sum += xyz;
    sums.fixedPerFlux = kPhotonUnits / (in.bands ? 1.0 : std::max({sum.x, sum.y, sum.z}));
    timer.stage("receiver_depth", [&] {
        // Light is thrown by mirrors, not shown on them.
        const auto mirror = [&](const scene::Object& object) { return in.scene.materials[static_cast<std::size_t>(object.material)].mirror; };
        receiverDepth_.run({in.gpu, in.scene.materials, out.mapView, in.transport.mapSize, false, 1.0, mirror}, sums.receivers);
        receiverDepth_.run({in.gpu, in.scene.materials, out.outerView, outerSizeOf(in.transport), false, 1.0, mirror}, sums.outerReceivers);
    });
    sums.landings.ensure(texelsOf(in.transport.mapSize) * sizeof(GLuint), GL_DYNAMIC_STORAGE_BIT, "landings");
    sums.outerLandings.ensure(texelsOf(outerSizeOf(in.transport)) * sizeof(GLuint), GL_DYNAMIC_STORAGE_BIT, "outer landings");
    clear(sums.landings), clear(sums.outerLandings);
    out.hasMap = true;
    if (in.bands) {
        traceBands(all, sums.milestone, timer, out);
        return;
    }
    const std::size_t words = layout::kWideWords * sizeof(GLuint);
    sums.map.ensure(texelsOf(in.transport.mapSize) * words, GL_DYNAMIC_STORAGE_BIT, "exact map");
    sums.outerMap.ensure(texelsOf(outerSizeOf(in.transport)) * words, GL_DYNAMIC_STORAGE_BIT, "exact outer map");
    clear(sums.map), clear(sums.outerMap);
    trace(all, sums.milestone, 0, static_cast<int>(sums.entries.nm.size()), timer, out);
    resolve(all, timer, out);
}

void TracedLightSide::add(const Inputs& all, gl::StageTimer& timer, LightMaps& out) {
    ExactSums& sums = *out.exact;
    const double afforded = tracingMsPerPhoton_ > 0.0 ? kAddMs / tracingMsPerPhoton_ : 0.0;
    const std::uint64_t photons = std::max<std::uint64_t>(static_cast<std::uint64_t>(afforded), 1024);
    trace(all, std::min(photons, sums.milestone - sums.photons), 0, static_cast<int>(sums.entries.nm.size()), timer, out);
    resolve(all, timer, out);
}

void TracedLightSide::trace(const Inputs& all, std::uint64_t photons, int firstEntry, int entries, gl::StageTimer& timer, LightMaps& out) {
    const LightSide::Inputs& in = all.light;
    ExactSums& sums = *out.exact;
    const bool bands = in.bands;
    const GLuint cookie = in.light.cookie >= 0 ? in.gpu.texture(in.light.cookie) : 0;
    ledger_.ensure(layout::kLedgerBanks * layout::kLedgerRows * sizeof(GLuint), GL_DYNAMIC_STORAGE_BIT, "energy ledger");
    clear(ledger_);
    // A row may hold all the flux of this frame's photons; rounding each to a whole unit is kept far below them.
    ledgerPerFlux_ = kFixedRange / static_cast<double>(photons);
    startedNs_ = nowNs();
    const int spectra = bands ? entries : sums.spectra;
    const std::uint64_t atOnce = std::min(kMostAtOnce, kMostThreads / static_cast<std::uint64_t>(spectra));
    timer.stage("photon_paths", [&] {
        for (const ExactEmitter& emitter : sums.emitters) {
            const double share = emitter.extent / sums.extent;
            const auto upTo = [&](std::uint64_t all_) { return static_cast<std::uint64_t>(share * static_cast<double>(all_)); };
            const std::uint64_t end = upTo(sums.photons + photons);
            for (std::uint64_t first = upTo(sums.photons); first < end; first += atOnce) {
                photonPaths_.run({.surfaces = all.surfaces, .table = sums.table, .emission = emitter.emission, .mapView = out.mapView,
                                  .outerView = out.outerView, .receivers = sums.receivers, .outerReceivers = sums.outerReceivers,
                                  .light = in.light, .cookie = cookie, .emitter = emitter.caster,
                                  .firstPhoton = static_cast<std::uint32_t>(first),
                                  .photons = static_cast<std::uint32_t>(std::min(atOnce, end - first)),
                                  .spectra = spectra, .firstEntry = firstEntry, .entries = entries,
                                  .continuous = sums.entries.continuous,
                                  .bandShare = bands ? 1.0 / static_cast<double>(sums.entries.nm.size()) : 0.0,
                                  .exactReceivers = in.plan.exactReceivers, .hidden = in.plan.hidden,
                                  .bounces = in.transport.bounces, .receiverSteps = in.transport.receiverSteps,
                                  .fixedPerFlux = sums.fixedPerFlux, .ledgerPerFlux = ledgerPerFlux_,
                                  .reachM = 8.0f * in.scene.geometry->bounds.radius()},
                                 {sums.map, sums.outerMap, sums.landings, sums.outerLandings, ledger_});
            }
        }
    });
    sentNs_ = nowNs();
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);   // sums -> map_adapt, read-back, the next dispatch
    tracedNow_ = photons;
    sums.photons += photons;
}

void TracedLightSide::resolve(const Inputs& all, gl::StageTimer& timer, LightMaps& out) {
    const LightSide::Inputs& in = all.light;
    ExactSums& sums = *out.exact;
    const int size = in.transport.mapSize, levels = levelsOf(in.transport);
    const double fluxPerFixed = sums.extent / (static_cast<double>(sums.photons) * sums.fixedPerFlux);
    ledgerPerFixed_ = kFixedRange / (static_cast<double>(sums.photons) * sums.fixedPerFlux);
    const double enough = kEnough * sums.spectra;
    timer.stage("map_adapt", [&] {
        adapt_[0].run({sums.map, sums.landings, size, levels, enough, ledgerPerFixed_}, kept_[0], ledger_);
        adapt_[1].run({sums.outerMap, sums.outerLandings, outerSizeOf(in.transport), levels, enough}, kept_[1], ledger_);
    });
    timer.stage("map_resolve", [&] {
        const auto run = [&](std::size_t which, const View& view, const gl::Texture& receivers, int side, gl::Texture& concentration) {
            resolve_[which].run({.map = nullptr, .kept = &kept_[which], .view = view, .receivers = receivers, .size = side, .levels = levels,
                                 .firstTexel = 0, .xyzToRgb = glm::mat3(out.wavelengths.xyzToRgb), .fluxPerFixed = fluxPerFixed,
                                 .ledgerPerFixed = ledgerPerFixed_, .judged = which == 0}, concentration, ledger_);
        };
        run(0, out.mapView, sums.receivers, size, out.map);
        run(1, out.outerView, sums.outerReceivers, outerSizeOf(in.transport), out.outerMap);
    });
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                    GL_TEXTURE_UPDATE_BARRIER_BIT);   // map -> camera_receivers, read-back
    out.mapHash = 0;
    if (in.hash) hash(all, out);
}

// As many wavelengths at a time as a storage buffer holds.
void TracedLightSide::traceBands(const Inputs& all, std::uint64_t photons, gl::StageTimer& timer, LightMaps& out) {
    const LightSide::Inputs& in = all.light;
    ExactSums& sums = *out.exact;
    const int size = in.transport.mapSize;
    const int outerSize = outerSizeOf(in.transport);
    const std::size_t texels = texelsOf(size), outer = texelsOf(outerSize), wavelengths = sums.entries.nm.size(), each = 2 * sizeof(GLuint);
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    const std::size_t batch = std::clamp<std::size_t>(static_cast<std::size_t>(most) / (texels * each), 1, wavelengths);
    out.bands.assign(texels * wavelengths, 0.0f);
    out.outerBands.assign(outer * wavelengths, 0.0f);
    out.mapHash = in.hash ? kFnvStart : 0;
    double inMaps = 0.0;
    for (std::size_t first = 0; first < wavelengths; first += batch) {
        const std::size_t count = std::min(batch, wavelengths - first);
        sums.map.ensure(texels * count * each, GL_DYNAMIC_STORAGE_BIT, "exact map");
        sums.outerMap.ensure(outer * count * each, GL_DYNAMIC_STORAGE_BIT, "exact outer map");
        clear(sums.map), clear(sums.outerMap), clear(sums.landings), clear(sums.outerLandings);
        sums.photons = 0;
        trace(all, photons, static_cast<int>(first), static_cast<int>(count), timer, out);
        const double fluxPerPhoton = sums.extent / static_cast<double>(photons);
        const auto collect = [&](const gl::Buffer& buffer, const gl::Buffer& landings, const View& view, int side, std::vector<float>& to) {
            const std::vector<GLuint> map = readWords(buffer, 2 * texelsOf(side) * count);
            if (in.hash) out.mapHash = fnv1a(out.mapHash, map);
            std::vector<float> light(texelsOf(side) * count);
            for (std::size_t i = 0; i < light.size(); ++i) {
                const double sum = wide(&map[2 * i]);
                inMaps += sum;
                light[i] = static_cast<float>(sum / sums.fixedPerFlux);
            }
            if (const int levels = levelsOf(in.transport); levels > 1) {
                light = sumPyramid(adaptPyramid(std::move(light), readWords(landings, texelsOf(side)), side, levels, static_cast<int>(count), static_cast<double>(count) * kEnough), side, levels, static_cast<int>(count));
            }
            for (std::size_t texel = 0; texel < texelsOf(side); ++texel) {
                const double scale = fluxPerPhoton / texelExtent(view, side, static_cast<int>(texel));
                for (std::size_t band = 0; band < count; ++band) {
                    to[texel * wavelengths + first + band] = static_cast<float>(light[texel * count + band] * scale);
                }
            }
        };
        collect(sums.map, sums.landings, out.mapView, size, out.bands);
        collect(sums.outerMap, sums.outerLandings, out.outerView, outerSize, out.outerBands);
        const std::vector<GLuint> words = readWords(ledger_, layout::kLedgerBanks * layout::kLedgerRows);
        for (std::size_t i = 0; i < words.size(); ++i) sums.ledger[i % layout::kLedgerRows] += words[i] / ledgerPerFlux_;
    }
    sums.ledger[layout::kLedgerPhotons] *= ledgerPerFlux_ / std::ceil(static_cast<double>(wavelengths) / static_cast<double>(batch));
    sums.ledger[layout::kLedgerDeposited] = inMaps / (sums.fixedPerFlux * static_cast<double>(wavelengths));
}

void TracedLightSide::complete(const Inputs& all, gl::StageTimer& timer, LightMaps& out) {
    ExactSums& sums = *out.exact;
    const std::uint64_t wanted = firstPhotons(all, sums.met);
    if (sums.photons >= wanted) return hash(all, out);
    sums.milestone = wanted;
    trace(all, wanted - sums.photons, 0, static_cast<int>(sums.entries.nm.size()), timer, out);
    resolve(all, timer, out);
    collect(all, out);
}

void TracedLightSide::hash(const Inputs& all, LightMaps& out) const {
    const std::size_t inner = texelsOf(all.light.transport.mapSize), outer = texelsOf(outerSizeOf(all.light.transport));
    out.mapHash = fnv1a(kFnvStart, readWords(out.exact->map, layout::kWideWords * inner));
    out.mapHash = fnv1a(out.mapHash, readWords(out.exact->outerMap, layout::kWideWords * outer));
}

void TracedLightSide::collect(const Inputs& all, LightMaps& out) {
    const LightSide::Inputs& in = all.light;
    if (!out.hasMap || tracedNow_ == 0) return;
    ExactSums& sums = *out.exact;
    const double fluxPerPhoton = sums.extent / static_cast<double>(sums.photons);
    if (!in.bands) {
        const std::vector<GLuint> words = readWords(ledger_, layout::kLedgerBanks * layout::kLedgerRows);
        std::array<double, layout::kLedgerRows> rows{};
        for (std::size_t i = 0; i < words.size(); ++i) rows[i % layout::kLedgerRows] += words[i];
        for (const int row : {layout::kLedgerOnCasters, layout::kLedgerAbsorbed, layout::kLedgerReflected, layout::kLedgerRejected,
                              layout::kLedgerLeftMap, layout::kLedgerNoReceiver, layout::kLedgerCut}) {
            sums.ledger[static_cast<std::size_t>(row)] += rows[static_cast<std::size_t>(row)] / ledgerPerFlux_;
        }
        sums.ledger[layout::kLedgerPhotons] += rows[layout::kLedgerPhotons];
        // Of the whole map, whenever it is resolved
        const double deposited = rows[layout::kLedgerDeposited];
        sums.ledger[layout::kLedgerDeposited] = deposited / (ledgerPerFixed_ * sums.fixedPerFlux);
        out.outerEmpty = rows[layout::kLedgerOuter] == 0.0;
        if (deposited > 0.0) {
            out.error = estimateError({.halves = rows[levelsOf(in.transport) > 2 ? layout::kLedgerCells : layout::kLedgerHalves] / deposited,
                                       .roughness = kRoughnessUnit * rows[layout::kLedgerRoughness] / deposited,
                                       .grain = kRoughnessUnit * rows[layout::kLedgerGrain] / deposited,
                                       .spectralStep = 0.0});
        }
        const std::uint64_t endedNs = nowNs();
        msPerPhoton_ = 1e-6 * static_cast<double>(endedNs - startedNs_) / static_cast<double>(tracedNow_);
        // Without what every frame takes however few its photons are: or fewer are afforded each time. Software GL alone
        // has traced when the call returns.
        tracingMsPerPhoton_ = all.software ? 1e-6 * static_cast<double>(sentNs_ - startedNs_) / static_cast<double>(tracedNow_) : msPerPhoton_;
        const double before = out.convergence ? out.convergence->progress : 0.0;
        Convergence& done = out.convergence.emplace();
        done.photons = sums.photons;
        done.error = out.error ? out.error->total : 0.0;
        done.target = targetOf(in.transport);
        const bool asked = sums.photons >= sums.milestone;
        if (asked) sums.milestone = static_cast<std::uint64_t>(std::ceil(kMilestone * static_cast<double>(sums.photons)));
        done.converged = asked && done.error <= done.target;
        // The error of evenly spread photons falls about as the square root of the cube of their number's.
        // What another estimate takes back of it comes again.
        done.progress = done.converged ? 1.0 : std::max(before, std::min(std::pow(done.target / std::max(done.error, 1e-9), 4.0 / 3.0), 0.99));
    }
    out.photons = static_cast<std::uint32_t>(std::min(sums.ledger[layout::kLedgerPhotons], 4294967295.0));
    out.ledger.onCasters = sums.ledger[layout::kLedgerOnCasters] * fluxPerPhoton;
    out.ledger.deposited = sums.ledger[layout::kLedgerDeposited] * fluxPerPhoton;
    out.ledger.absorbed = sums.ledger[layout::kLedgerAbsorbed] * fluxPerPhoton;
    out.ledger.reflected = sums.ledger[layout::kLedgerReflected] * fluxPerPhoton;
    out.ledger.rejected = sums.ledger[layout::kLedgerRejected] * fluxPerPhoton;
    out.ledger.leftMap = sums.ledger[layout::kLedgerLeftMap] * fluxPerPhoton;
    out.ledger.noReceiver = sums.ledger[layout::kLedgerNoReceiver] * fluxPerPhoton;
    out.ledger.cut = sums.ledger[layout::kLedgerCut] * fluxPerPhoton;
    tracedNow_ = 0;
}

}  // namespace caustream::render
