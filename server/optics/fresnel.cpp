#include "optics/fresnel.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace caustream::optics {

// Born & Wolf 1999, Principles of Optics, section 1.5: the mean of both polarisations' reflectances.
double fresnelDielectric(double cosI, double eta) {
    cosI = std::clamp(cosI, 0.0, 1.0);
    const double sin2T = eta * eta * (1.0 - cosI * cosI);
    if (sin2T >= 1.0) return 1.0;
    const double cosT = std::sqrt(1.0 - sin2T);
    if (eta * cosI + cosT == 0.0 || cosI + eta * cosT == 0.0) return 1.0;
    const double perpendicular = (eta * cosI - cosT) / (eta * cosI + cosT);
    const double parallel = (cosI - eta * cosT) / (cosI + eta * cosT);
    return 0.5 * (perpendicular * perpendicular + parallel * parallel);
}

std::optional<glm::dvec3> refract(const glm::dvec3& d, const glm::dvec3& n, double eta) {
    const double cosI = -glm::dot(d, n);
    const double sin2T = eta * eta * (1.0 - cosI * cosI);
    if (sin2T >= 1.0) return std::nullopt;
    return eta * d + (eta * cosI - std::sqrt(1.0 - sin2T)) * n;
}

}  // namespace caustream::optics
