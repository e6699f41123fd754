#include "optics/dispersion.h"

#include <algorithm>
#include <cmath>

namespace caustream::optics {

namespace {

double square(double x) {
    return x * x;
}

double index(const ConstantIndex& d, double) {
    return d.n;
}

double index(const Cauchy& d, double um) {
    return d.A + d.B_um2 / square(um) + d.C_um4 / square(square(um));
}

// The two constants make n(587.56 nm) = n_d and n(486.1) - n(656.3) = (n_d - 1) / V_d.
double index(const Abbe& d, double um) {
    const double slope = (d.n_d - 1.0) / d.V_d;
    return std::max(1.0, d.n_d + slope * (0.523655 / square(um) - 1.5168));
}

double index(const Sellmeier& d, double um) {
    double nSquared = 1.0;
    for (int i = 0; i < 3; ++i)
        if (d.B[i] != 0.0) nSquared += d.B[i] * square(um) / (square(um) - d.C_um2[i]);
    return std::sqrt(std::max(0.0, nSquared));
}

bool disperses(const ConstantIndex&) {
    return false;
}
bool disperses(const Cauchy& d) {
    return d.B_um2 != 0.0 || d.C_um4 != 0.0;
}
bool disperses(const Abbe& d) {
    return std::isfinite(d.V_d) && d.n_d != 1.0;
}
bool disperses(const Sellmeier& d) {
    for (int i = 0; i < 3; ++i)
        if (d.B[i] != 0.0 && d.C_um2[i] != 0.0) return true;
    return false;
}

}  // namespace

double refractiveIndex(const Dispersion& dispersion, double wavelengthNm) {
    return std::visit([&](const auto& d) { return index(d, wavelengthNm * 1e-3); }, dispersion);
}

bool isDispersive(const Dispersion& dispersion) {
    return std::visit([](const auto& d) { return disperses(d); }, dispersion);
}

// Cauchy: Blanchette 2012, Adaptive Spectral Mapping, table 1; the exaggerated glass is the one of its figure 23.
// Sellmeier: Schott's catalogue (SF11) and Peter 1923 (diamond).
const std::array<GlassPreset, 8> kGlassPresets{{
    {"fused silica", Cauchy{1.4580, 0.00354, 0.0}},
    {"BK7", Cauchy{1.5046, 0.00420, 0.0}},
    {"K5", Cauchy{1.5220, 0.00459, 0.0}},
    {"BaK4", Cauchy{1.5690, 0.00531, 0.0}},
    {"BaF10", Cauchy{1.6700, 0.00743, 0.0}},
    {"SF11", Sellmeier{{1.73848403, 0.311168974, 1.17490871}, {0.0136068604, 0.0615960463, 121.922711}}},
    {"diamond", Sellmeier{{0.3306, 4.3356, 0.0}, {0.030625, 0.011236, 0.0}}},
    {"exaggerated", Cauchy{1.4580, 0.6, 0.0}},
}};

}  // namespace caustream::optics
