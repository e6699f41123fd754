#include "render/thesis_light_side.h"

#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>

#include "render/light_views.h"
#include "render/map_energy.h"
#include "render/thesis_colours.h"

namespace caustream::render {

namespace {

constexpr int kCoarseGrid = 16;      // photons a side of the trace that tells whether the cone holds the caustic
constexpr glm::vec3 kLuminance(0.2126f, 0.7152f, 0.0722f);   // BT.709

std::uint64_t fnv1a(std::uint64_t hash, const std::vector<glm::vec4>& texels) {
    for (const glm::vec4& texel : texels) {
        std::uint32_t words[4];
        std::memcpy(words, &texel, sizeof words);
        for (const std::uint32_t word : words) hash = (hash ^ word) * 0x100000001b3ull;
    }
    return hash;
}

void clear(const gl::Texture& image, const glm::vec4& value) { glClearTexImage(image.get(), 0, GL_RGBA, GL_FLOAT, &value[0]); }

}  // namespace

struct ThesisLightSide::Target {
    const gl::Texture* map;
    bool alpha;                      // the fourth channel takes a band
    std::vector<double> nm;
    std::vector<glm::vec4> weights;
};

// The one view, and the casters that the light reaches.
View ThesisLightSide::findView(const LightSide::Inputs& in, LightMaps& out, std::vector<const scene::Object*>& casters) const {
    std::vector<double> outermost = {out.wavelengths.nm.front()};
    if (out.wavelengths.nm.size() > 1) outermost.push_back(out.wavelengths.nm.back());
    std::vector<Landing> landings;
    std::vector<View> emissions;
    glm::vec3 mean(0.0f);
    float flux = 0.0f;
    for (const scene::Object& object : in.scene.geometry->objects) {
        const scene::Material& material = in.scene.materials[static_cast<std::size_t>(object.material)];
        if (!refracts(material, in.scene.outsideIndex)) continue;
        const auto emission = emissionView(in.scene, in.light, object);
        if (!emission) continue;
        casters.push_back(&object);
        emissions.push_back(*emission);
        for (Landing landing : in.tracer.trace(in.scene, in.light, object, *emission, kCoarseGrid, outermost)) {
            landing.flux *= static_cast<float>(emission->extent());
            mean += landing.flux * landing.position, flux += landing.flux;
            landings.push_back(landing);
        }
    }
    out.landing = flux > 0.0f ? mean / flux : in.scene.geometry->casterBounds.centre();
    return wholeView(in.scene, in.light, landings, emissions);
}

// One image for the picture's three channels, or one for every four bands.
std::vector<ThesisLightSide::Target> ThesisLightSide::makeTargets(const LightSide::Inputs& in, LightMaps& out) {
    const int size = in.transport.mapSize;
    const std::vector<double>& nm = out.wavelengths.nm;
    std::vector<Target> targets;
    if (!in.bands) {
        out.map.ensure(size, size, GL_RGBA32F, "spectral map");
        clear(out.map, glm::vec4(0, 0, 0, 1));   // alpha 1: on whatever receiver it falls
        targets.push_back({&out.map, false, nm, {}});
        for (const glm::dvec3& rgb : out.wavelengths.xyz) targets.back().weights.emplace_back(glm::vec3(rgb), 0.0f);
        return targets;
    }
    bandMaps_.resize((nm.size() + 3) / 4);
    for (std::size_t i = 0; i < bandMaps_.size(); ++i) {
        bandMaps_[i].ensure(size, size, GL_RGBA32F, "bands");
        clear(bandMaps_[i], glm::vec4(0.0f));
        targets.push_back({&bandMaps_[i], true, {}, {}});
        for (std::size_t k = 0; k < 4 && 4 * i + k < nm.size(); ++k) {
            targets.back().nm.push_back(nm[4 * i + k]);
            targets.back().weights.emplace_back(0.0f);
            targets.back().weights.back()[static_cast<int>(k)] = 1.0f;
        }
    }
    return targets;
}

void ThesisLightSide::traceCaster(const LightSide::Inputs& in, const scene::Object& caster, std::size_t index, const View& view,
                                  const std::vector<Target>& targets, gl::StageTimer& timer) {
    const scene::Material& material = in.scene.materials[static_cast<std::size_t>(caster.material)];
    const int grid = in.transport.photonGrid, levels = hierarchyLevels(grid, in.transport.hierarchyLevels);
    timer.stage("caster_layers", [&] {
        casterLayers_.run({in.gpu, caster, view, grid, grid, nullptr, levels + 1}, CasterLayers::Side::Front, front_);
        casterLayers_.run({in.gpu, caster, view, grid, grid, nullptr}, CasterLayers::Side::Back, back_);
    });
    if (photons_.size() <= index) photons_.push_back(gl::makeQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN));
    const PhotonPoints* photons = nullptr;
    timer.stage("photon_hierarchy", [&] { photons = &hierarchy_.run({front_, levels, photons_[index].get()}); });
    timer.stage("photon_splat", [&] {
        const GLuint cookie = in.light.cookie >= 0 ? in.gpu.texture(in.light.cookie) : 0;
        for (const Target& target : targets) {
            std::vector<PhotonSplat::Wavelength> wavelengths;
            for (std::size_t i = 0; i < target.nm.size(); ++i) {
                const double index_ = optics::refractiveIndex(material.dispersion, target.nm[i]) / in.scene.outsideIndex;
                wavelengths.push_back({static_cast<float>(index_), target.weights[i]});
            }
            splat_.run({front_, back_, receivers_, view, *photons, in.light, cookie, wavelengths}, target.alpha, *target.map);
        }
    });
}

// Of the caster in front_.
double ThesisLightSide::fluxOn(const LightSide::Inputs& in, const View& view) const {
    const glm::mat3 toWorld = glm::transpose(glm::mat3(view.worldToView));
    const std::vector<glm::vec4> texels = readTexels(front_);
    double flux = 0.0;
    const int size = front_.width();
    for (int i = 0; i < size * size; ++i) {
        if (texels[static_cast<std::size_t>(i)].w <= 0.0f) continue;
        const glm::vec2 uv = (glm::vec2(i % size, i / size) + 0.5f) / static_cast<float>(size);
        const glm::vec3 dir((2.0f * uv - 1.0f) * view.halfExtent, -1.0f);
        const double share = view.perspective ? coneFalloff(in.light, glm::normalize(toWorld * dir)) : 1.0;
        flux += share * texelExtent(view, size, i);
    }
    return flux;
}

// Bands for the client; for a still the hash and the two terms of the ledger that are known.
void ThesisLightSide::readBack(const LightSide::Inputs& in, const std::vector<Target>& targets, double onCasters, LightMaps& out) const {
    const int size = in.transport.mapSize;
    const std::size_t bands = out.wavelengths.nm.size();
    const auto area = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
    if (in.bands) out.bands.resize(area * bands);
    out.mapHash = in.hash ? 0xcbf29ce484222325ull : 0;
    double deposited = 0.0;
    for (std::size_t t = 0; t < targets.size(); ++t) {
        const std::vector<glm::vec4> texels = readTexels(*targets[t].map);
        if (in.hash) out.mapHash = fnv1a(out.mapHash, texels);
        for (std::size_t i = 0; i < area; ++i) {
            double light = in.bands ? 0.0 : glm::dot(glm::vec3(texels[i]), kLuminance);
            for (std::size_t k = 0; in.bands && k < targets[t].nm.size(); ++k) {
                const float band = texels[i][static_cast<int>(k)];
                out.bands[i * bands + 4 * t + k] = band;
                light += band / static_cast<double>(bands);
            }
            deposited += light * texelExtent(out.mapView, size, static_cast<int>(i));
        }
    }
    if (!in.hash || in.light.cookie >= 0) return;
    out.ledger.onCasters = onCasters;
    out.ledger.deposited = deposited;
    out.warnings.push_back("the published transport books neither what glass reflects or absorbs nor what leaves the map: "
                           "of its ledger only the flux on casters and in the map are known, and it does not close");
}

void ThesisLightSide::run(const LightSide::Inputs& in, gl::StageTimer& timer, LightMaps& out) {
    out.hasMap = false;
    out.bands.clear();
    out.warnings.clear();
    out.ledger = {};
    out.residuals.reset();
    out.error.reset();
    out.photons = 0;
    out.mapHash = 0;
    casters_ = 0;
    out.wavelengths = in.transport.wavelengthsNm.empty() ? thesisWavelengths(in.plan.wavelengths)
                                                         : thesisWavelengthsAt(in.transport.wavelengthsNm);
    out.seen = out.wavelengths;
    out.hasShadow = in.plan.runs("receiver_depth");
    std::vector<const scene::Object*> casters;
    const View view = in.plan.runs("photon_splat") ? findView(in, out, casters) : wholeView(in.scene, in.light, {}, {});
    out.shadowView = out.mapView = out.outerView = view;
    if (out.hasShadow) {
        timer.stage("receiver_depth", [&] {
            receiverDepth_.run({in.gpu, in.scene.materials, view, kShadowSize, true, in.scene.outsideIndex}, out.shadow);
        });
    }
    out.castersLit = static_cast<int>(casters.size());
    out.lands = !casters.empty();
    if (!in.plan.runs("photon_splat")) return;
    if (casters.empty()) {
        out.warnings.push_back("the light \"" + in.light.name + "\" reaches no caster: aim it at one");
        return;
    }

    timer.stage("receiver_depth", [&] { receiverDepth_.run({in.gpu, in.scene.materials, view, in.transport.mapSize}, receivers_); });
    const std::vector<Target> targets = makeTargets(in, out);
    double onCasters = 0.0;
    for (const scene::Object* caster : casters) {
        traceCaster(in, *caster, casters_++, view, targets, timer);
        if (in.hash) onCasters += fluxOn(in, view);
    }
    if (!out.outerMap || out.outerMap.width() != 1) {
        out.outerMap.ensure(1, 1, GL_RGBA32F, "outer map");   // nothing lies outside the one view
        clear(out.outerMap, glm::vec4(0, 0, 0, 1));
    }
    out.hasMap = true;
    if (in.bands || in.hash) readBack(in, targets, onCasters, out);
}

void ThesisLightSide::collect(LightMaps& out) const {
    for (std::size_t i = 0; i < casters_; ++i) {
        GLuint photons = 0;
        glGetQueryObjectuiv(photons_[i].get(), GL_QUERY_RESULT, &photons);
        out.photons += photons;
    }
}

}  // namespace caustream::render
