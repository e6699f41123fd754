#include "render/spectral_table.h"

#include <algorithm>
#include <cmath>

namespace caustream::render {

namespace {

double total(const glm::dvec3& xyz) { return xyz.x + xyz.y + xyz.z; }

// A new buffer each time: the one before may still be read.
void upload(gl::Buffer& buffer, gl::BufferTexture& texels, const std::vector<glm::vec4>& values, const char* label) {
    buffer = gl::Buffer(values.size() * sizeof(glm::vec4), values.data(), 0, label);
    texels.view(buffer, GL_RGBA32F);
}

}  // namespace

SpectralEntries spectralEntries(const optics::WavelengthSet& set) {
    if (set.cumulative.empty()) return {set.nm, set.xyz, false};
    SpectralEntries entries;
    entries.continuous = true;
    // Places of the band up to which i / kContinuousEntries of the light lies
    const auto& table = set.cumulative;
    std::size_t step = 0;
    double place = 0.0;
    glm::dvec3 below(0.0);
    for (int i = 1; i <= kContinuousEntries; ++i) {
        const double wanted = total(table.back()) * i / kContinuousEntries;
        while (step + 2 < table.size() && total(table[step + 1]) < wanted) ++step;
        const double range = total(table[step + 1]) - total(table[step]);
        const double within = range > 0.0 ? std::clamp((wanted - total(table[step])) / range, 0.0, 1.0) : 1.0;
        const glm::dvec3 upTo = i == kContinuousEntries ? table.back() : glm::mix(table[step], table[step + 1], within);
        const double end = (static_cast<double>(step) + within) / optics::kSpectrumSteps;
        entries.nm.push_back(optics::placeInBand(0.5 * (place + end)));
        entries.xyz.push_back(glm::max((upTo - below) * static_cast<double>(kContinuousEntries), glm::dvec3(0.0)));
        place = end, below = upTo;
    }
    return entries;
}

void SpectralTable::fill(const scene::Scene& scene, std::span<const ExactCaster> casters, const SpectralEntries& entries) {
    std::vector<glm::vec4> glasses, colours;
    glasses.reserve(entries.nm.size() * casters.size());
    std::vector<const scene::Material*> materials;
    std::vector<optics::Absorption> mirrors;   // of a metre of it exp(-perM) is left: what the mirror's colour leaves of white
    for (const ExactCaster& caster : casters) {
        materials.push_back(&scene.materials[static_cast<std::size_t>(scene.geometry->objects[caster.object].material)]);
        const glm::dvec3 color = glm::clamp(glm::dvec3(materials.back()->baseColor), glm::dvec3(1e-4), glm::dvec3(1.0));
        mirrors.push_back(caster.mirror ? optics::absorptionFromRgb(color, 1.0) : optics::Absorption{});
    }
    for (std::size_t e = 0; e < entries.nm.size(); ++e) {
        const double nm = entries.nm[e];
        for (std::size_t c = 0; c < casters.size(); ++c) {
            glasses.emplace_back(optics::refractiveIndex(materials[c]->dispersion, nm), materials[c]->absorption.at(nm),
                                 casters[c].mirror ? std::exp(-mirrors[c].at(nm)) : -1.0, 0.0);
        }
        colours.emplace_back(entries.xyz[e], entries.xyz[e].y);
    }
    if (glasses.empty()) glasses.emplace_back(1.0f);
    upload(glasses_, glassTexels_, glasses, "glasses");
    upload(colours_, colourTexels_, colours, "colours");
    casters_ = static_cast<int>(casters.size());
    outsideIndex_ = static_cast<float>(scene.outsideIndex);
}

void SpectralTable::bind(const gl::Uniforms& uniforms, GLuint firstUnit) const {
    glBindTextureUnit(firstUnit, glassTexels_.get());
    glBindTextureUnit(firstUnit + 1, colourTexels_.get());
    uniforms.set("u_glasses", static_cast<int>(firstUnit))
        .set("u_colours", static_cast<int>(firstUnit) + 1)
        .set("u_casters", casters_)
        .set("u_outsideIndex", outsideIndex_);
}

}  // namespace caustream::render
