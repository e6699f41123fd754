#include "optics/spectrum.h"

#include <algorithm>
#include <cmath>

#include "optics/cie_tables.h"

namespace caustream::optics {

namespace {

double power(const EqualEnergy&, double) {
    return 1.0;
}

double power(const DaylightD65&, double nm) {
    const double x = (nm - kBandMinNm) / kD65StepNm;
    const std::size_t i = std::min<std::size_t>(static_cast<std::size_t>(x), kD65.size() - 2);
    return std::lerp(kD65[i], kD65[i + 1], x - static_cast<double>(i)) / 100.0;
}

// Planck 1900, relative to the red end of the band: the exponents are subtracted before exp, so that no temperature
// overflows.
double power(const Blackbody& light, double nm) {
    constexpr double kSecondRadiationNmK = 1.438776877e7;  // h c / k
    const double kelvin = std::max(light.kelvin, 1.0);
    const double x = kSecondRadiationNmK / (nm * kelvin), xRed = kSecondRadiationNmK / (kBandMaxNm * kelvin);
    return std::pow(kBandMaxNm / nm, 5.0) * std::exp(xRed - x) * std::expm1(-xRed) / std::expm1(-x);
}

double power(const Lines&, double) {
    return 0.0;
}

}  // namespace

double relativePower(const Spectrum& spectrum, double wavelengthNm) {
    if (!(wavelengthNm >= kBandMinNm && wavelengthNm <= kBandMaxNm)) return 0.0;
    return std::visit([&](const auto& light) { return power(light, wavelengthNm); }, spectrum);
}

}  // namespace caustream::optics
