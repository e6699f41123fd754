// Relative spectral power of a light over the band 380-680 nm.
#pragma once
#include <variant>
#include <vector>

namespace caustream::optics {

inline constexpr double kBandMinNm = 380.0;
inline constexpr double kBandMaxNm = 680.0;

struct EqualEnergy {};
struct DaylightD65 {};
struct Blackbody {
    double kelvin = 5000.0;
};
struct Lines {  // monochromatic lines of equal power, nm
    std::vector<double> nm;
};
using Spectrum = std::variant<EqualEnergy, DaylightD65, Blackbody, Lines>;

// Relative power at `wavelengthNm`, any scale; 0 outside the band and, for Lines, always (they have no density).
double relativePower(const Spectrum& spectrum, double wavelengthNm);

}  // namespace caustream::optics
