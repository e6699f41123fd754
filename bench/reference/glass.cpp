#include "bench/reference/glass.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace caustream::tracer {

double indexAt(const optics::Dispersion& dispersion, double nm) {
    const double um2 = nm * nm * 1e-6;
    if (const auto* constant = std::get_if<optics::ConstantIndex>(&dispersion)) return constant->n;
    if (const auto* cauchy = std::get_if<optics::Cauchy>(&dispersion)) {
        return cauchy->A + (cauchy->B_um2 + cauchy->C_um4 / um2) / um2;
    }
    if (const auto* abbe = std::get_if<optics::Abbe>(&dispersion)) {
        // KHR_materials_dispersion, "Dispersion".
        return std::max(abbe->n_d + (abbe->n_d - 1.0) / abbe->V_d * (523655.0 / (nm * nm) - 1.5168), 1.0);
    }
    const auto& sellmeier = std::get<optics::Sellmeier>(dispersion);
    double n2 = 1.0;
    for (std::size_t i = 0; i < sellmeier.B.size(); ++i) {
        if (sellmeier.B[i] != 0.0) n2 += sellmeier.B[i] * um2 / (um2 - sellmeier.C_um2[i]);
    }
    return std::sqrt(std::max(n2, 1.0));
}

double absorptionAt(const optics::Absorption& absorption, double nm) {
    const auto& x = absorption.nm;
    if (x.empty()) return 0.0;
    const auto after = std::upper_bound(x.begin(), x.end(), nm);
    if (after == x.begin()) return absorption.perM.front();
    if (after == x.end()) return absorption.perM.back();
    const auto i = static_cast<std::size_t>(after - x.begin());
    const double t = (nm - x[i - 1]) / (x[i] - x[i - 1]);
    return absorption.perM[i - 1] * (1.0 - t) + absorption.perM[i] * t;
}

// Born & Wolf 1999, Principles of Optics, 1.5.2, eqs. 20 and 21, in cosines; the mean of both polarisations.
Split meet(const glm::dvec3& d, const glm::dvec3& n, double nFrom, double nInto) {
    const double cosFrom = std::min(-glm::dot(d, n), 1.0);
    Split split;
    split.reflected = glm::normalize(d + 2.0 * cosFrom * n);
    if (nFrom == nInto) {  // nothing there: not even rounding may turn the ray
        split.reflectance = 0.0;
        split.transmitted = d;
        return split;
    }
    const double eta = nFrom / nInto, sinInto2 = eta * eta * (1.0 - cosFrom * cosFrom);
    if (sinInto2 >= 1.0) return split;
    const double cosInto = std::sqrt(1.0 - sinInto2);
    split.transmitted = glm::normalize(eta * d + (eta * cosFrom - cosInto) * n);
    const double s = (nFrom * cosFrom - nInto * cosInto) / (nFrom * cosFrom + nInto * cosInto);
    const double p = (nInto * cosFrom - nFrom * cosInto) / (nInto * cosFrom + nFrom * cosInto);
    split.reflectance = 0.5 * (s * s + p * p);
    return split;
}

}  // namespace caustream::tracer
