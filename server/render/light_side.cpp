#include "render/light_side.h"

#include <algorithm>
#include <cmath>

#include "render/error_estimate.h"
#include "render/light_views.h"
#include "render/map_energy.h"
#include "render/map_pyramid.h"
#include "shaders/shared/layout.h"

namespace caustream::render {

namespace {

constexpr int kSeenWavelengths = 16;     // of a continuous spectrum on the camera's side, which traces a few nodes of them
constexpr int kCoarseGrid = 16;         // photons a side of the trace that the map's view is fitted to
constexpr int kOuterMapSize = 64;        // holds half a per cent of the light: few photons, wide texels

static_assert(optics::kSpectrumSteps == layout::kSpectrumSteps);

// Photons per side of the emission view, as many texels in all as a square grid but square on the light's sphere.
glm::ivec2 gridSize(const View& view, int grid) {
    const float aspect = std::sqrt(view.halfExtent.x / view.halfExtent.y);
    const auto side = [](float texels) { return std::clamp(static_cast<int>(std::lround(texels)), 8, 8192); };
    return {side(static_cast<float>(grid) * aspect), side(static_cast<float>(grid) / aspect)};
}

int levelsOf(const Transport& transport) { return transport.filter ? layout::kMostLevels : 1; }

// The spectrum and the glass all along the band; empty unless it is continuous.
std::vector<SpectrumStep> spectrumOf(const optics::WavelengthSet& set, const scene::Material& material, double outsideIndex) {
    std::vector<SpectrumStep> steps;
    for (const glm::dvec3& xyz : set.cumulative) {
        const double nm = optics::placeInBand(static_cast<double>(steps.size()) / optics::kSpectrumSteps);
        steps.push_back({xyz, outsideIndex / optics::refractiveIndex(material.dispersion, nm), material.absorption.at(nm)});
    }
    return steps;
}

}  // namespace

optics::WavelengthSet wavelengthsOf(const LightSide::Inputs& in) {
    const Transport& transport = in.transport;
    if (!transport.wavelengthsNm.empty()) return optics::sampleWavelengthsAt(transport.wavelengthsNm, in.light.spectrum, in.observer);
    if (in.plan.continuous) return optics::continuousSpectrum(in.plan.wavelengths, in.light.spectrum, in.observer);
    return optics::sampleWavelengths(in.plan.wavelengths, in.light.spectrum, in.observer);
}

optics::WavelengthSet seenWavelengths(const LightSide::Inputs& in, const optics::WavelengthSet& traced) {
    return traced.cumulative.empty() ? traced : optics::sampleWavelengths(kSeenWavelengths, in.light.spectrum, in.observer);
}

bool shadesNothing(const LightSide::Inputs& in, const scene::Object& object) {
    return !in.scene.materials[static_cast<std::size_t>(object.material)].caster && !in.enclosure.shades(object, in.light) &&
           !in.forced.has(Omission::Walls);
}

GLuint LightSide::white() {
    const std::uint8_t texel[4] = {255, 255, 255, 255};
    if (white_.ensure(1, 1, GL_RGBA8, "white cookie")) glTextureSubImage2D(white_.get(), 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, texel);
    return white_.get();
}

LightFit LightSide::fit(const Inputs& in) {
    LightFit fit;
    const optics::WavelengthSet set = wavelengthsOf(in);
    const bool unlitToo = in.forced.has(Omission::UnlitGlass);
    std::vector<Landing> landings;
    std::vector<double> coarse = {set.nm.front()};
    // Where colours go the same way, one is enough: the fit is then that of a single wavelength.
    const auto& materials = in.scene.materials;
    const bool spreads = std::any_of(materials.begin(), materials.end(), [&](const scene::Material& material) {
        return refracts(material, in.scene.outsideIndex) && optics::isDispersive(material.dispersion);
    });
    if (set.nm.size() > 1 && spreads) coarse.push_back(set.nm.back());
    for (const scene::Object& object : in.scene.geometry->objects) {
        const scene::Material& material = in.scene.materials[static_cast<std::size_t>(object.material)];
        if (!refracts(material, in.scene.outsideIndex)) continue;
        auto emission = emissionView(in.scene, in.light, object);
        if (!emission && unlitToo) emission = backView(in.scene, in.light, object);
        if (!emission) continue;
        const std::vector<Landing> own = in.tracer.trace(in.scene, in.light, object, *emission, kCoarseGrid, coarse);
        for (const Landing& landing : own) {
            landings.push_back({landing.position, landing.flux * static_cast<float>(emission->extent())});
        }
        fit.casters.push_back({&object, &material, *emission, backView(in.scene, in.light, object)});
    }
    if (!fit.casters.empty()) fit.views = mapViews(in.scene, in.light, landings);
    return fit;
}

void LightSide::traceCaster(const Inputs& in, const LitCaster& emitter, std::size_t firstWavelength, std::size_t count,
                            double fixedPerFlux, gl::StageTimer& timer, const LightMaps& out) {
    const int grid = in.transport.photonGrid;
    const glm::ivec2 front = gridSize(emitter.emission, grid);
    const int back = in.transport.backLayer > 0 ? in.transport.backLayer : grid > 512 ? 512 : 256;
    const bool bands = in.bands;
    const GLuint cookie = in.light.cookie >= 0 ? in.gpu.texture(in.light.cookie) : in.forced.has(Omission::Cookie) ? white() : 0;
    const float radius = emitter.caster->bounds.radius();

    timer.stage("caster_layers", [&] {
        // A photon counts only where its caster is the first thing that its ray meets.
        const auto others = [&] {
            in.gpu.drawWhere([&](const scene::Object& object) {
                const scene::Material& material = in.scene.materials[static_cast<std::size_t>(object.material)];
                return &object != emitter.caster && !shadesNothing(in, object) && (!material.caster || refracts(material, in.scene.outsideIndex));
            });
        };
        casterLayers_.run({in.gpu, *emitter.caster, emitter.emission, front.x, front.y, others}, CasterLayers::Side::Front, front_);
        casterLayers_.run({in.gpu, *emitter.caster, emitter.back, back, back, nullptr}, CasterLayers::Side::Back, back_);
    });
    timer.stage("photon_list", [&] { photonList_.run({front_, emitter.emission, in.light, cookie}, list_, ledger_); });
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);   // list -> trace and its dispatch size

    std::vector<TracedWavelength> wavelengths;
    const bool continuous = !out.wavelengths.cumulative.empty();
    // Of a continuous spectrum: the luminance from this wavelength to the next.
    const auto interval = [&](std::size_t i) {
        const auto upTo = [&](std::size_t node) {
            const double at = std::min(1.0, static_cast<double>(node) / static_cast<double>(count - 1)) * optics::kSpectrumSteps;
            const auto step = std::min(static_cast<std::size_t>(at), out.wavelengths.cumulative.size() - 2);
            return std::lerp(out.wavelengths.cumulative[step].y, out.wavelengths.cumulative[step + 1].y, at - static_cast<double>(step));
        };
        return upTo(i + 1) - upTo(i);
    };
    for (std::size_t i = firstWavelength; i < firstWavelength + count; ++i) {
        const double nm = out.wavelengths.nm[i];
        const double weightY = bands ? 1.0 / static_cast<double>(out.wavelengths.nm.size()) : continuous ? interval(i) : out.wavelengths.xyz[i].y;
        wavelengths.push_back({nm, in.scene.outsideIndex / optics::refractiveIndex(emitter.material->dispersion, nm),
                               emitter.material->absorption.at(nm), weightY, out.wavelengths.xyz[i]});
    }
    timer.stage("photon_trace", [&] {
        photonTrace_.run({.front = front_, .back = back_, .receivers = receivers_, .outerReceivers = outerReceivers_,
                          .emission = emitter.emission, .backView = emitter.back, .mapView = out.mapView,
                          .outerView = out.outerView, .list = list_, .light = in.light, .cookie = cookie,
                          .wavelengths = std::move(wavelengths),
                          .spectrum = spectrumOf(out.wavelengths, *emitter.material, in.scene.outsideIndex), .bands = bands ? static_cast<int>(count) : 0,
                          .fixedPerFlux = fixedPerFlux, .ledgerPerFlux = kFixedRange / totalFlux_,
                          .levels = levelsOf(in.transport),
                          .backSteps = in.transport.backSteps, .receiverSteps = in.transport.receiverSteps,
                          .exitToleranceM = 0.1f * radius,
                          .reachM = 8.0f * std::max(in.scene.geometry->bounds.radius(), radius),
                          .residuals = in.countResiduals ? &residuals_ : nullptr,
                          .absorption = in.forced.has(Omission::Absorption)},
                         {map_, ledger_});
    });
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);   // map -> resolve, read-back
}

void LightSide::judgeSpectrum(const Inputs& in, const std::vector<LitCaster>& emitters, const LightMaps& out) {
    SpectralSpread all;
    for (const LitCaster& emitter : emitters) {
        const SpectralSpread own = spectralSpread(in.tracer, in.scene, in.light, *emitter.caster, emitter.emission, out.mapView);
        const float flux = own.flux * static_cast<float>(emitter.emission.extent());
        all.ends += flux * own.ends, all.bend += flux * own.bend, all.flux += flux;
    }
    if (all.flux <= 0.0f) return;
    all.ends /= all.flux, all.bend /= all.flux;
    const int size = in.transport.mapSize;
    const glm::vec2 step = spectralStep(all, static_cast<int>(out.wavelengths.nm.size()), in.plan.continuous, size);
    // All the light in one texel of the widest view still fits 32 bits.
    const double perTexel = kFixedRange / 8.0 / totalFlux_ * texelExtent(out.mapView, size, size / 2 * (size + 1));
    spectralStep_.run({out.map, step, perTexel}, ledger_);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);   // ledger -> read-back
}

void LightSide::tracePicture(const Inputs& in, const std::vector<LitCaster>& emitters, gl::StageTimer& timer, LightMaps& out) {
    const int size = in.transport.mapSize, levels = levelsOf(in.transport);
    const std::size_t texels = pyramidTexels(size, levels), outer = kOuterMapSize * kOuterMapSize;
    map_.ensure(layout::kMapWords * (texels + outer) * sizeof(GLuint), GL_DYNAMIC_STORAGE_BIT, "fixed-point map");
    glClearNamedBufferData(map_.get(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);

    glm::dvec3 sum(0.0);
    for (const glm::dvec3& weight : out.wavelengths.xyz) sum += weight;
    const double fixedPerFlux = kFixedRange / (totalFlux_ * std::max({sum.x, sum.y, sum.z}));
    for (const LitCaster& emitter : emitters) traceCaster(in, emitter, 0, out.wavelengths.nm.size(), fixedPerFlux, timer, out);

    timer.stage("map_resolve", [&] {
        const auto resolve = [&](const View& view, const gl::Texture& receivers, int side, int sideLevels, std::size_t first, bool judged, gl::Texture& concentration) {
            mapResolve_.run({.map = &map_, .view = view, .receivers = receivers, .size = side, .levels = sideLevels, .firstTexel = static_cast<int>(first),
                             .xyzToRgb = glm::mat3(out.wavelengths.xyzToRgb), .fluxPerFixed = 1.0 / fixedPerFlux,
                             .ledgerPerFixed = kFixedRange / totalFlux_ / fixedPerFlux, .judged = judged},
                            concentration, ledger_);
        };
        resolve(out.mapView, receivers_, size, levels, 0, true, out.map);
        resolve(out.outerView, outerReceivers_, kOuterMapSize, 1, texels, false, out.outerMap);
    });
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                    GL_TEXTURE_UPDATE_BARRIER_BIT);   // map -> camera_receivers, gap_fill, read-back
    if (in.plan.runs("spectral_step")) timer.stage("spectral_step", [&] { judgeSpectrum(in, emitters, out); });
    if (in.hash) out.mapHash = fnv1a(kFnvStart, readWords(map_, layout::kMapWords * (texels + outer)));
}

void LightSide::traceBands(const Inputs& in, const std::vector<LitCaster>& emitters, gl::StageTimer& timer, LightMaps& out) {
    const int size = in.transport.mapSize, levels = levelsOf(in.transport);
    const std::size_t finest = pyramidTexels(size, 1), texels = pyramidTexels(size, levels) + kOuterMapSize * kOuterMapSize;
    const std::size_t wavelengths = out.wavelengths.nm.size();
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    const std::size_t batch = std::clamp<std::size_t>(static_cast<std::size_t>(most) / (texels * sizeof(GLuint)), 1, wavelengths);
    const double fixedPerFlux = kFixedRange / totalFlux_;
    out.bands.assign(finest * wavelengths, 0.0f);
    out.mapHash = in.hash ? kFnvStart : 0;
    batches_ = static_cast<int>((wavelengths + batch - 1) / batch);
    double inMap = 0.0;
    for (std::size_t first = 0; first < wavelengths; first += batch) {
        const std::size_t count = std::min(batch, wavelengths - first), words = texels * count;
        map_.ensure(words * sizeof(GLuint), GL_DYNAMIC_STORAGE_BIT, "fixed-point map");
        glClearNamedBufferData(map_.get(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
        for (const LitCaster& emitter : emitters) traceCaster(in, emitter, first, count, fixedPerFlux, timer, out);
        const std::vector<GLuint> map = readWords(map_, words);
        if (in.hash) out.mapHash = fnv1a(out.mapHash, map);
        for (const GLuint word : map) inMap += word;
        const std::vector<float> summed = sumPyramid(map, size, levels, static_cast<int>(count));
        for (std::size_t texel = 0; texel < finest; ++texel) {
            const double scale = 1.0 / (fixedPerFlux * texelExtent(out.mapView, size, static_cast<int>(texel)));
            for (std::size_t band = 0; band < count; ++band) {
                out.bands[texel * wavelengths + first + band] = static_cast<float>(summed[texel * count + band] * scale);
            }
        }
    }
    out.ledger.deposited = inMap / (fixedPerFlux * static_cast<double>(wavelengths));
}

void LightSide::run(const Inputs& in, const LightFit& fit, gl::StageTimer& timer, LightMaps& out) {
    out.hasMap = false;
    out.bands.clear();
    out.warnings.clear();
    out.ledger = {};
    out.residuals.reset();
    out.photons = 0;
    out.error.reset();
    out.mapHash = 0;
    totalFlux_ = 0.0;
    batches_ = 1;
    out.wavelengths = wavelengthsOf(in);
    out.seen = seenWavelengths(in, out.wavelengths);
    if (in.plan.casters > 0 && fit.casters.empty()) {
        out.warnings.push_back("the light \"" + in.light.name + "\" reaches no caster: aim it at one");
    } else if (!fit.casters.empty() && !fit.views) {
        out.warnings.push_back("no light that passes a caster lands on a receiver: no caustic to show");
    }
    out.hasShadow = in.plan.shadow;
    if (out.hasShadow) {
        out.shadowView = shadowView(in.scene, in.light);
        timer.stage("receiver_depth", [&] {
            receiverDepth_.run({in.gpu, in.scene.materials, out.shadowView, kShadowSize, true, in.scene.outsideIndex,
                                [&](const scene::Object& object) { return shadesNothing(in, object); }}, out.shadow);
        });
    }
    if (!in.plan.runs("photon_trace")) return;
    // Where the plan runs this though no light lands (it was forced), any view of the receivers does.
    const std::vector<LitCaster>& emitters = fit.casters;
    const MapViews views = fit.views.value_or(MapViews{shadowView(in.scene, in.light), shadowView(in.scene, in.light), {}});
    out.mapView = views.inner;
    out.outerView = views.outer;
    out.landing = views.landing;
    for (const LitCaster& emitter : emitters) totalFlux_ += emitter.emission.extent();
    if (emitters.empty()) totalFlux_ = 1.0;

    ledger_.ensure(layout::kLedgerBanks * layout::kLedgerRows * sizeof(GLuint), GL_DYNAMIC_STORAGE_BIT, "energy ledger");
    glClearNamedBufferData(ledger_.get(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
    if (in.countResiduals) {
        residuals_.ensure(layout::kResidualHistograms * layout::kResidualBins * sizeof(GLuint), GL_DYNAMIC_STORAGE_BIT, "residuals");
        glClearNamedBufferData(residuals_.get(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
        out.residuals.emplace();
    }
    timer.stage("receiver_depth", [&] {
        receiverDepth_.run({in.gpu, in.scene.materials, out.mapView, in.transport.mapSize}, receivers_);
        receiverDepth_.run({in.gpu, in.scene.materials, out.outerView, kOuterMapSize}, outerReceivers_);
    });
    out.hasMap = true;
    if (in.bands) {
        traceBands(in, emitters, timer, out);
    } else {
        tracePicture(in, emitters, timer, out);
    }
}

void LightSide::collect(LightMaps& out) const {
    if (totalFlux_ <= 0.0) return;
    const std::vector<GLuint> words = readWords(ledger_, layout::kLedgerBanks * layout::kLedgerRows);
    double rows[layout::kLedgerRows] = {};
    for (std::size_t i = 0; i < words.size(); ++i) rows[i % layout::kLedgerRows] += words[i];
    const double flux = totalFlux_ / kFixedRange;
    out.photons = static_cast<std::uint32_t>(rows[layout::kLedgerPhotons] / batches_);
    out.ledger.onCasters = rows[layout::kLedgerOnCasters] * flux;
    out.ledger.absorbed = rows[layout::kLedgerAbsorbed] * flux;
    out.ledger.reflected = rows[layout::kLedgerReflected] * flux;
    out.ledger.totalReflection = rows[layout::kLedgerTotalReflection] * flux;
    out.ledger.rejected = rows[layout::kLedgerRejected] * flux;
    out.ledger.leftMap = rows[layout::kLedgerLeftMap] * flux;
    out.ledger.noReceiver = rows[layout::kLedgerNoReceiver] * flux;
    out.outerEmpty = out.bands.empty() && rows[layout::kLedgerOuter] == 0.0;
    if (out.bands.empty()) {
        const double deposited = rows[layout::kLedgerDeposited];
        out.ledger.deposited = deposited * flux;
        if (deposited > 0.0) {
            out.error = estimateError({.halves = rows[layout::kLedgerHalves] / deposited,
                                       .roughness = kRoughnessUnit * rows[layout::kLedgerRoughness] / deposited,
                                       .grain = kRoughnessUnit * rows[layout::kLedgerGrain] / deposited,
                                       .spectralStep = rows[layout::kLedgerStep] / std::max(rows[layout::kLedgerStepOf], 1.0)});
        }
    }
    if (!out.residuals) return;
    const std::vector<GLuint> counts = readWords(residuals_, layout::kResidualHistograms * layout::kResidualBins);
    const auto histogram = [&](int which, Residuals::Histogram& to) {
        std::copy_n(counts.begin() + which * layout::kResidualBins, layout::kResidualBins, to.begin());
    };
    histogram(layout::kResidualExit, out.residuals->exit);
    histogram(layout::kResidualExitFollowed, out.residuals->exitFollowed);
    histogram(layout::kResidualReceiver, out.residuals->receiver);
}

}  // namespace caustream::render
