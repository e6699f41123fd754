#include "optics/colour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "optics/cie_tables.h"

namespace caustream::optics {

namespace {

constexpr double kLineDNm = 587.56;  // helium d: where n_d is measured

glm::dvec3 matching(Observer observer, double nm) { return observer == Observer::Cie1931 ? cieXyz(nm) : wymanXyz(nm); }

// Integral of the matching functions times a power, from the start of the band, every nm.
class CumulativeXyz {
 public:
    CumulativeXyz(const Spectrum& spectrum, Observer observer) {
        const auto density = [&](double at) { return matching(observer, at) * relativePower(spectrum, at); };
        sum_[0] = glm::dvec3(0.0);
        for (int i = 0; i < kCount; ++i) {
            // Midpoint and ends (Simpson 1743): exact for the piecewise linear tables.
            const double nm = kBandMinNm + i;
            sum_[i + 1] =
                sum_[i] +
                (density(nm) + 4.0 * density(nm + 0.5) + density(nm + 1.0)) / 6.0;
        }
    }

    glm::dvec3 upTo(double nm) const {
        const double x = std::clamp(nm - kBandMinNm, 0.0, static_cast<double>(kCount));
        const int i = std::min(static_cast<int>(x), kCount - 1);
        return sum_[i] + (x - i) * (sum_[i + 1] - sum_[i]);
    }
    glm::dvec3 total() const { return sum_[kCount]; }

 private:
    static constexpr int kCount = static_cast<int>(kBandMaxNm - kBandMinNm);

    std::array<glm::dvec3, kCount + 1> sum_;
};

const CumulativeXyz& equalEnergyXyz() {
    static const CumulativeXyz table{EqualEnergy{}, Observer::Cie1931};
    return table;
}

// ITU-R BT.709-6: XYZ of D65 to linear RGB. Rows are R, G, B.
glm::dmat3 bt709() {
    return glm::transpose(glm::dmat3(3.2404542, -1.5371385, -0.4985314,  //
                                     -0.9692660, 1.8760108, 0.0415560,   //
                                     0.0556434, -0.2040259, 1.0572252));
}

glm::dmat3 scaleRows(const glm::dmat3& m, const glm::dvec3& scale) {
    return glm::dmat3(m[0] * scale, m[1] * scale, m[2] * scale);
}

double luminance(const glm::dvec3& rgb) {
    return glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722));
}

// Adds the light's colour and the matrix that divides by it, and scales the weights to Y = 1.
void finish(WavelengthSet& set, Observer observer) {
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& xyz : set.xyz) sum += xyz;
    for (glm::dvec3& xyz : set.xyz) xyz /= sum.y;
    for (glm::dvec3& xyz : set.cumulative) xyz /= sum.y;
    sum /= sum.y;

    const glm::dmat3 toRgb = xyzToRgb(observer);
    const glm::dvec3 rgb = toRgb * sum;
    const double brightest = std::max({rgb.r, rgb.g, rgb.b});
    glm::dmat3 rows = glm::transpose(toRgb);
    for (int c = 0; c < 3; ++c) {
        // A single line lies outside BT.709: a channel it does not reach carries the luminance instead, times a light
        // colour of nearly nothing.
        const bool reached = rgb[c] > 1e-3 * brightest;
        rows[c] = reached ? rows[c] / rgb[c] : glm::dvec3(0.0, 1.0, 0.0);
    }
    set.xyzToRgb = glm::transpose(rows);
    const glm::dvec3 inGamut = glm::max(rgb, glm::dvec3(0.0));
    set.lightRgb = inGamut / luminance(inGamut);
}

double middle(double aNm, double bNm) {
    return 1.0 / std::sqrt(0.5 * (1.0 / (aNm * aNm) + 1.0 / (bNm * bNm)));
}

// The lines inside the band, ascending, each once.
std::vector<double> usableLines(const Spectrum& spectrum) {
    std::vector<double> nm;
    if (const auto* lines = std::get_if<Lines>(&spectrum))
        for (double line : lines->nm)
            if (line >= kBandMinNm && line <= kBandMaxNm) nm.push_back(line);
    std::sort(nm.begin(), nm.end());
    nm.erase(std::unique(nm.begin(), nm.end()), nm.end());
    return nm;
}

CumulativeXyz tableOf(const Spectrum& spectrum, Observer observer) {
    const bool noLines = std::holds_alternative<Lines>(spectrum);   // none in the band, else they would be used
    return {noLines ? Spectrum{EqualEnergy{}} : spectrum, observer};
}

// `edges` has one entry more than `nm`.
WavelengthSet weigh(std::vector<double> nm, std::span<const double> edges, const Spectrum& spectrum, Observer observer) {
    WavelengthSet set;
    set.nm = std::move(nm);
    set.xyz.resize(set.nm.size(), glm::dvec3(0.0));
    if (const std::vector<double> lines = usableLines(spectrum); !lines.empty()) {
        for (double line : lines) {
            const auto upper = std::upper_bound(edges.begin() + 1, edges.end() - 1, line);
            set.xyz[static_cast<std::size_t>(upper - edges.begin()) - 1] += matching(observer, line);
        }
    } else {
        const CumulativeXyz table = tableOf(spectrum, observer);
        for (std::size_t i = 0; i < set.nm.size(); ++i)
            set.xyz[i] = glm::max(table.upTo(edges[i + 1]) - table.upTo(edges[i]), glm::dvec3(0.0));
    }
    finish(set, observer);
    return set;
}

}  // namespace

glm::dvec3 cieXyz(double wavelengthNm) {
    if (!(wavelengthNm >= kBandMinNm && wavelengthNm <= kBandMaxNm)) return glm::dvec3(0.0);
    const double x = (wavelengthNm - kBandMinNm) / kCieStepNm;
    const std::size_t i = std::min<std::size_t>(static_cast<std::size_t>(x), kCie1931.size() - 2);
    const double t = x - static_cast<double>(i);
    const auto &a = kCie1931[i], &b = kCie1931[i + 1];
    return {std::lerp(a[0], b[0], t), std::lerp(a[1], b[1], t), std::lerp(a[2], b[2], t)};
}

glm::dvec3 wymanXyz(double wavelengthNm) {
    if (!(wavelengthNm >= kBandMinNm && wavelengthNm <= kBandMaxNm)) return glm::dvec3(0.0);
    const auto lobe = [&](double height, double middleNm, double belowNm, double aboveNm) {
        const double t = (wavelengthNm - middleNm) / (wavelengthNm < middleNm ? belowNm : aboveNm);
        return height * std::exp(-0.5 * t * t);
    };
    return {lobe(0.362, 442.0, 16.0, 26.7) + lobe(1.056, 599.8, 37.9, 31.0) - lobe(0.065, 501.1, 20.4, 26.2),
            lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1),
            lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8)};
}

glm::dvec3 intervalXyz(double aNm, double bNm) {
    const CumulativeXyz& table = equalEnergyXyz();
    return (table.upTo(bNm) - table.upTo(aNm)) / table.total().y;
}

glm::dmat3 xyzToRgb(Observer observer) {
    const glm::dvec3 total = CumulativeXyz(EqualEnergy{}, observer).total();
    const glm::dvec3 white = bt709() * (total / total.y);
    return scaleRows(bt709(), 1.0 / white);
}

double placeInBand(double x) {
    return 1.0 / std::sqrt(std::lerp(1.0 / (kBandMinNm * kBandMinNm), 1.0 / (kBandMaxNm * kBandMaxNm), x));
}

WavelengthSet sampleWavelengths(int count, const Spectrum& spectrum, Observer observer) {
    if (const std::vector<double> lines = usableLines(spectrum); !lines.empty())
        return sampleWavelengthsAt(lines, spectrum, observer);
    if (count <= 1) return sampleWavelengthsAt(std::array{kLineDNm}, spectrum, observer);

    std::vector<double> nm, edges{kBandMinNm};
    for (int i = count - 1; i >= 0; --i) {
        nm.push_back(placeInBand(1.0 - (i + 0.5) / count));
        edges.push_back(i == 0 ? kBandMaxNm : placeInBand(1.0 - static_cast<double>(i) / count));
    }
    return weigh(std::move(nm), edges, spectrum, observer);
}

WavelengthSet continuousSpectrum(int nodes, const Spectrum& spectrum, Observer observer) {
    if (const std::vector<double> lines = usableLines(spectrum); !lines.empty())
        return sampleWavelengthsAt(lines, spectrum, observer);
    WavelengthSet set;
    const CumulativeXyz table = tableOf(spectrum, observer);
    set.cumulative = {glm::dvec3(0.0)};
    for (int i = 0; i < kSpectrumSteps; ++i) {
        const auto upTo = [&](int step) {
            return step == kSpectrumSteps ? table.total() : table.upTo(placeInBand(static_cast<double>(step) / kSpectrumSteps));
        };
        // The fit's red lobe dips below 0 near 500 nm; light is never taken away.
        set.cumulative.push_back(set.cumulative.back() + glm::max(upTo(i + 1) - upTo(i), glm::dvec3(0.0)));
    }
    set.xyz.resize(static_cast<std::size_t>(nodes), glm::dvec3(0.0));
    for (int i = 0; i < nodes; ++i) {
        set.nm.push_back(i == 0 ? kBandMinNm : i + 1 == nodes ? kBandMaxNm : placeInBand(static_cast<double>(i) / (nodes - 1)));
        const auto place = [&](double node) {
            const double at = std::clamp(node / (nodes - 1), 0.0, 1.0) * kSpectrumSteps;
            const auto step = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kSpectrumSteps - 1));
            return glm::mix(set.cumulative[step], set.cumulative[step + 1], at - static_cast<double>(step));
        };
        set.xyz[static_cast<std::size_t>(i)] = place(i + 0.5) - place(i - 0.5);
    }
    finish(set, observer);
    return set;
}

WavelengthSet sampleWavelengthsAt(std::span<const double> nm, const Spectrum& spectrum, Observer observer) {
    std::vector<double> edges{kBandMinNm};
    for (std::size_t i = 1; i < nm.size(); ++i) edges.push_back(middle(nm[i - 1], nm[i]));
    edges.push_back(kBandMaxNm);
    return weigh({nm.begin(), nm.end()}, edges, spectrum, observer);
}

}  // namespace caustream::optics
