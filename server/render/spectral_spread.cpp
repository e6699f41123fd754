#include "render/spectral_spread.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <vector>

#include "optics/spectrum.h"

namespace caustream::render {

namespace {
constexpr int kGrid = 8;

double middleNm() {
    const double red = 1.0 / (optics::kBandMaxNm * optics::kBandMaxNm), violet = 1.0 / (optics::kBandMinNm * optics::kBandMinNm);
    return 1.0 / std::sqrt(0.5 * (red + violet));
}
}  // namespace

SpectralSpread spectralSpread(const CoarseTrace& tracer, const scene::Scene& scene, const scene::Light& light,
                              const scene::Object& caster, const View& emission, const View& map) {
    const std::vector<Landing> landings = tracer.trace(scene, light, caster, emission, kGrid,
                                                       {optics::kBandMinNm, middleNm(), optics::kBandMaxNm});
    const glm::mat4 toClip = map.worldToClip();
    SpectralSpread spread;
    // A photon's landings follow each other; one that lost a wavelength on the way tells nothing of the spectrum.
    for (std::size_t i = 0; i + 2 < landings.size(); ++i) {
        const Landing &violet = landings[i], &middle = landings[i + 1], &red = landings[i + 2];
        if (violet.photon != middle.photon || middle.photon != red.photon) continue;
        const auto place = [&](const Landing& landing) {
            const glm::vec4 clip = toClip * glm::vec4(landing.position, 1.0f);
            return 0.5f * glm::vec2(clip) / std::max(clip.w, 1e-6f);
        };
        const glm::vec2 a = place(violet), b = place(middle), c = place(red);
        spread.ends += middle.flux * glm::abs(a - c);
        spread.bend += middle.flux * glm::abs(b - 0.5f * (a + c));
        spread.flux += middle.flux;
    }
    if (spread.flux > 0.0f) spread.ends /= spread.flux, spread.bend /= spread.flux;
    return spread;
}

glm::vec2 spectralStep(const SpectralSpread& spread, int wavelengths, bool continuous, int size) {
    const float texels = static_cast<float>(size);
    if (!continuous) return texels * spread.ends / static_cast<float>(wavelengths);
    // A parabola's chord over 1 / n of its width is off by 1 / n^2 of its height, 2/3 of that in the mean.
    const float intervals = static_cast<float>(std::max(wavelengths - 1, 1));
    return texels * spread.bend * (2.0f / 3.0f) / (intervals * intervals);
}

}  // namespace caustream::render
