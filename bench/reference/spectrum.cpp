#include "bench/reference/spectrum.h"

#include <cmath>

#include "optics/colour.h"

namespace caustream::tracer {

namespace {

// A Gaussian whose two sides have their own standard deviations, nm.
double lobe(double nm, double middle, double belowNm, double aboveNm) {
    const double t = (nm - middle) / (nm < middle ? belowNm : aboveNm);
    return std::exp(-0.5 * t * t);
}

constexpr double kBandNm = optics::kBandMaxNm - optics::kBandMinNm;

}  // namespace

glm::dvec3 wymanXyz(double nm) {
    return {0.362 * lobe(nm, 442.0, 16.0, 26.7) + 1.056 * lobe(nm, 599.8, 37.9, 31.0) - 0.065 * lobe(nm, 501.1, 20.4, 26.2),
            0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
            1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)};
}

SpectrumSampler::SpectrumSampler(const optics::Spectrum& spectrum, Observer observer, int samples)
    : spectrum_(spectrum), observer_(observer), samples_(samples) {
    if (samples == 0) return;
    if (const auto* lines = std::get_if<optics::Lines>(&spectrum)) {
        lines_ = lines->nm;
        luminance_ = 0.0;
        for (const double nm : lines_) luminance_ += observe(nm).y;
        return;
    }
    // Midpoints of 1/16 nm: beyond single precision for these smooth functions and tables.
    constexpr int kSteps = 16 * static_cast<int>(kBandNm);
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double nm = optics::kBandMinNm + (i + 0.5) * kBandNm / kSteps;
        sum += observe(nm).y * optics::relativePower(spectrum, nm);
    }
    luminance_ = sum * kBandNm / kSteps;
}

glm::dvec3 SpectrumSampler::observe(double nm) const {
    return observer_ == Observer::Wyman2013 ? wymanXyz(nm) : optics::cieXyz(nm);
}

WavelengthSample SpectrumSampler::at(std::size_t i, double place) const {
    if (!lines_.empty()) {
        const double nm = lines_[i];
        return {nm, observe(nm) / luminance_, 1.0 / static_cast<double>(lines_.size())};
    }
    const double part = kBandNm / samples_, nm = optics::kBandMinNm + (static_cast<double>(i) + place) * part;
    return {nm, observe(nm) * (optics::relativePower(spectrum_, nm) * part / luminance_), 1.0 / samples_};
}

}  // namespace caustream::tracer
