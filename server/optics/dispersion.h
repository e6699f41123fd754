// Refractive index as a function of wavelength. Wavelengths in nm at this interface, inside the formulas in um.
#pragma once
#include <array>
#include <variant>

namespace caustream::optics {

struct ConstantIndex {
    double n = 1.5;
};
struct Cauchy {  // n(l) = A + B/l^2 + C/l^4 (Cauchy 1836), l in um
    double A = 1.458, B_um2 = 0.00354, C_um4 = 0.0;
};
struct Abbe {  // KHR_materials_dispersion: n(l) = max(n_d + (n_d - 1)/V_d (523655/l^2 - 1.5168), 1), l in nm
    double n_d = 1.5, V_d = 60.0;
};
struct Sellmeier {  // n^2 = 1 + sum B_i l^2 / (l^2 - C_i) (Sellmeier 1872), l in um
    std::array<double, 3> B{}, C_um2{};
};
using Dispersion = std::variant<ConstantIndex, Cauchy, Abbe, Sellmeier>;

// Refractive index at `wavelengthNm`; dimensionless, >= 1 for every preset.
double refractiveIndex(const Dispersion& dispersion, double wavelengthNm);

// False when the index is the same at every wavelength (B = C = 0, constant).
bool isDispersive(const Dispersion& dispersion);

// Named glasses (Blanchette 2012, table 1, and catalogue Sellmeier glasses), for lists and tests.
struct GlassPreset {
    const char* name;
    Dispersion dispersion;
};
extern const std::array<GlassPreset, 8> kGlassPresets;

}  // namespace caustream::optics
