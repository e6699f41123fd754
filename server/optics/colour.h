// CIE 1931 2-degree observer to linear BT.709, normalised so that equal energy over the band is exactly (1, 1, 1).
#pragma once
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "optics/spectrum.h"

namespace caustream::optics {

// Colour matching functions at `wavelengthNm`: the tabulated observer, interpolated. Relative units.
glm::dvec3 cieXyz(double wavelengthNm);

// Integral of the matching functions over [a, b] nm for equal energy, from one cumulative table, divided so that the
// whole band has Y = 1: any partition of the band sums to the band exactly.
glm::dvec3 intervalXyz(double aNm, double bNm);

// XYZ (as above) -> linear BT.709, each channel divided by that of equal energy over the band.
glm::dmat3 xyzToRgb();

// The wavelengths a light is traced at and what each contributes to the picture.
struct WavelengthSet {
    std::vector<double> nm;            // exact wavelengths, ascending
    std::vector<glm::dvec3> xyz;       // weight of each; >= 0. Sums to (X, Y, Z) with xyzToRgb * sum = (1, 1, 1)
    glm::dmat3 xyzToRgb{1.0};          // includes the division by the light's own colour, so white stays 1
    glm::dvec3 lightRgb{1.0};          // the light's own colour, linear BT.709, luminance 1
};

// `count` wavelengths in 1..64, uniform in 1/lambda^2 (centres of equal intervals); 1 gives 587.56 nm, white.
// For Lines the lines themselves, whatever `count` says.
WavelengthSet sampleWavelengths(int count, const Spectrum& spectrum = EqualEnergy{});

// The given wavelengths (ascending, in the band); each weighs the interval up to the midpoints to its neighbours.
WavelengthSet sampleWavelengthsAt(std::span<const double> nm, const Spectrum& spectrum = EqualEnergy{});

}  // namespace caustream::optics
