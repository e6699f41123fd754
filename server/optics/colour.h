// CIE 1931 2-degree observer to linear BT.709, normalised so that equal energy over the band is exactly (1, 1, 1).
#pragma once
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "optics/spectrum.h"

namespace caustream::optics {

// Whose colour matching functions. References that were made with the fit compare with the fit; pictures use the table.
enum class Observer { Cie1931, Wyman2013 };

// Colour matching functions at `wavelengthNm`: the tabulated observer, interpolated. Relative units.
glm::dvec3 cieXyz(double wavelengthNm);

// The same observer as a fit of seven lobes, up to 1e-2 of its peaks away: Wyman, Sloan and Shirley 2013, Simple Analytic
// Approximations to the CIE XYZ Color Matching Functions, eq. 4, with its widths in nm.
glm::dvec3 wymanXyz(double wavelengthNm);

// Integral of the matching functions over [a, b] nm for equal energy, from one cumulative table, divided so that the
// whole band has Y = 1: any partition of the band sums to the band exactly.
glm::dvec3 intervalXyz(double aNm, double bNm);

// XYZ (as above) -> linear BT.709, each channel divided by that of equal energy over the band.
glm::dmat3 xyzToRgb(Observer observer = Observer::Cie1931);

// The wavelengths a light is traced at and what each contributes to the picture.
struct WavelengthSet {
    std::vector<double> nm;            // exact wavelengths, ascending
    std::vector<glm::dvec3> xyz;       // weight of each; >= 0. Sums to (X, Y, Z) with xyzToRgb * sum = (1, 1, 1)
    glm::dmat3 xyzToRgb{1.0};          // includes the division by the light's own colour, so white stays 1
    glm::dvec3 lightRgb{1.0};          // the light's own colour, linear BT.709, luminance 1
    // Continuous spectra only: XYZ of the light from kBandMinNm up to the place i / kSpectrumSteps of the band, uniform in
    // 1/lambda^2. Never falls; the last one is the sum of `xyz`.
    std::vector<glm::dvec3> cumulative;
};
inline constexpr int kSpectrumSteps = 128;

// nm at the place `x` of the band, 0 (kBandMinNm) to 1 (kBandMaxNm), uniform in 1/lambda^2: refraction by Cauchy glass is
// linear in it.
double placeInBand(double x);

// `count` wavelengths in 1..64, uniform in 1/lambda^2 (centres of equal intervals); 1 gives 587.56 nm, white.
// For Lines the lines themselves, whatever `count` says.
WavelengthSet sampleWavelengths(int count, const Spectrum& spectrum = EqualEnergy{}, Observer observer = Observer::Cie1931);

// The whole spectrum from `nodes` (2..64) wavelengths, uniform in 1/lambda^2 with the ends of the band among them; what
// lies between them is interpolated. Each weighs half of the intervals beside it. For Lines the lines themselves.
WavelengthSet continuousSpectrum(int nodes, const Spectrum& spectrum = EqualEnergy{}, Observer observer = Observer::Cie1931);

// The given wavelengths (ascending, in the band); each weighs the interval up to the midpoints to its neighbours.
WavelengthSet sampleWavelengthsAt(std::span<const double> nm, const Spectrum& spectrum = EqualEnergy{},
                                  Observer observer = Observer::Cie1931);

}  // namespace caustream::optics
