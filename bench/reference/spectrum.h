// The continuous spectrum: which wavelengths a photon carries and what each adds to XYZ.
#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "bench/reference/tracer.h"

namespace caustream::tracer {

// CIE 1931 matching functions by the multi-lobe fit of Wyman, Sloan & Shirley 2013, Simple Analytic Approximations to
// the CIE XYZ Color Matching Functions, with widths in nm as the reference maps have them (the paper prints rounded
// inverses: .07% less X). Relative units.
glm::dvec3 wymanXyz(double nm);

struct WavelengthSample {
    double nm = 0;
    glm::dvec3 xyz{0.0};   // its part of the integral over the band, over that of Y alone
    double share = 0;      // for means over the spectrum; a photon's add up to 1
};

class SpectrumSampler {
 public:
    // `samples` a photon; of a light of lines every photon carries all lines, whatever `samples` says. 0: none.
    SpectrumSampler(const optics::Spectrum& spectrum, Observer observer, int samples);

    std::size_t count() const { return lines_.empty() ? static_cast<std::size_t>(samples_) : lines_.size(); }

    // Wavelength `i` of the photon whose place within each part of the band is `place`, 0..1.
    WavelengthSample at(std::size_t i, double place) const;

 private:
    glm::dvec3 observe(double nm) const;

    optics::Spectrum spectrum_;
    Observer observer_;
    int samples_;
    std::vector<double> lines_;
    double luminance_ = 1.0;   // integral of power times ybar over the band, or its sum over the lines
};

}  // namespace caustream::tracer
