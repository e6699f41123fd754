#include "render/thesis_colours.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/frame.h"

namespace caustream::render {

namespace {

constexpr double kFirstNm = 380.0, kStepNm = 50.0, kWhiteNm = 587.56;

// As the printed shader has them; table 2 shows them times 255, rounded up, which is why each channel sums to 893 there
// and to 3.5 here.
const std::array<glm::dvec3, 7> kColours = {{
    {0.3, 0.0, 0.8},   // 380 nm
    {0.2, 0.2, 1.0},
    {0.0, 0.9, 1.0},
    {0.3, 1.0, 0.4},
    {0.8, 0.9, 0.3},
    {0.9, 0.5, 0.0},
    {1.0, 0.0, 0.0},   // 680 nm
}};

glm::dvec3 colourAt(double nm) {
    const double place = std::clamp((nm - kFirstNm) / kStepNm, 0.0, static_cast<double>(kColours.size() - 1));
    const auto below = std::min(static_cast<std::size_t>(place), kColours.size() - 2);
    const double f = place - static_cast<double>(below);
    return (1.0 - f) * kColours[below] + f * kColours[below + 1];
}

}  // namespace

int thesisWavelengthCount(int asked) {
    if (asked == kContinuous) return 7;
    return asked < 4 ? 1 : asked < 14 ? 7 : 21;
}

optics::WavelengthSet thesisWavelengthsAt(std::span<const double> nm) {
    optics::WavelengthSet set;
    set.nm.assign(nm.begin(), nm.end());
    glm::dvec3 sum(0.0);
    for (const double wavelength : nm) set.xyz.push_back(colourAt(wavelength)), sum += set.xyz.back();
    for (glm::dvec3& weight : set.xyz) {
        // A channel that none of a few wavelengths has is shared evenly: white must stay white.
        for (int k = 0; k < 3; ++k) weight[k] = sum[k] > 0.0 ? weight[k] / sum[k] : 1.0 / static_cast<double>(nm.size());
    }
    return set;
}

optics::WavelengthSet thesisWavelengths(int count) {
    std::vector<double> nm = {kWhiteNm};
    if (count > 1) nm.clear();
    for (int i = 0; count > 1 && i < count; ++i) nm.push_back(kFirstNm + 6.0 * kStepNm * i / (count - 1));
    return thesisWavelengthsAt(nm);
}

}  // namespace caustream::render
