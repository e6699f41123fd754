#include "optics/absorption.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "optics/colour.h"

namespace caustream::optics {

namespace {

// Jakob & Hanika 2019, A Low-Dimensional Function Space for Efficient Spectral Upsampling: a transmittance
// S(c0 + c1 x + c2 x^2) with the sigmoid S(u) = 1/2 + u / (2 sqrt(1 + u^2)), x = 0..1 over the band. It never leaves
// (0, 1), so sigma is never negative.
constexpr int kNodes = 151;
constexpr double kStepNm = (kBandMaxNm - kBandMinNm) / (kNodes - 1);

double transmittance(const glm::dvec3& c, double x) {
    const double u = c.x + x * (c.y + x * c.z);
    // Written for the small tail: 1/2 + u/(2 sqrt(1+u^2)) cancels when u is far below zero.
    const double root = std::sqrt(1.0 + u * u);
    return u > 0.0 ? 0.5 + 0.5 * u / root : 0.5 / (root * (root - u));
}

// RGB of each node's share of the band under white light.
const std::array<glm::dvec3, kNodes>& nodeRgb() {
    static const std::array<glm::dvec3, kNodes> rgb = [] {
        std::array<glm::dvec3, kNodes> result;
        for (int i = 0; i < kNodes; ++i) {
            const double nm = kBandMinNm + i * kStepNm;
            result[i] = xyzToRgb() * intervalXyz(nm - 0.5 * kStepNm, nm + 0.5 * kStepNm);
        }
        return result;
    }();
    return rgb;
}

glm::dvec3 colourOf(const glm::dvec3& c) {
    glm::dvec3 sum(0.0);
    for (int i = 0; i < kNodes; ++i) sum += transmittance(c, i / (kNodes - 1.0)) * nodeRgb()[i];
    return sum;
}

// Levenberg-Marquardt on the three coefficients; keeps the best it has seen.
glm::dvec3 solve(const glm::dvec3& target, glm::dvec3 c) {
    glm::dvec3 error = target - colourOf(c);
    double damping = 1e-3;
    for (int step = 0; step < 60 && glm::dot(error, error) > 1e-20; ++step) {
        glm::dmat3 jacobian;
        for (int k = 0; k < 3; ++k) {
            const double h = 1e-5 * std::max(1.0, std::abs(c[k]));
            glm::dvec3 moved = c;
            moved[k] += h;
            jacobian[k] = (colourOf(moved) - colourOf(c)) / h;
        }
        glm::dmat3 normal = glm::transpose(jacobian) * jacobian;
        for (int k = 0; k < 3; ++k) normal[k][k] *= 1.0 + damping;
        for (int k = 0; k < 3; ++k) normal[k][k] += 1e-18;
        const glm::dvec3 next = c + glm::inverse(normal) * (glm::transpose(jacobian) * error);
        const glm::dvec3 nextError = target - colourOf(next);
        if (glm::dot(nextError, nextError) < glm::dot(error, error)) {
            c = next;
            error = nextError;
            damping = std::max(1e-12, 0.2 * damping);
        } else {
            damping *= 5.0;
        }
    }
    return c;
}

}  // namespace

double Absorption::at(double wavelengthNm) const {
    if (nm.empty()) return 0.0;
    const auto upper = std::upper_bound(nm.begin(), nm.end(), wavelengthNm);
    if (upper == nm.begin()) return perM.front();
    if (upper == nm.end()) return perM.back();
    const std::size_t i = static_cast<std::size_t>(upper - nm.begin());
    return std::lerp(perM[i - 1], perM[i], (wavelengthNm - nm[i - 1]) / (nm[i] - nm[i - 1]));
}

Absorption absorptionFromRgb(const glm::dvec3& attenuationColor, double distanceM) {
    if (!std::isfinite(distanceM) || distanceM <= 0.0) return {};
    const glm::dvec3 target = glm::clamp(attenuationColor, glm::dvec3(1e-4), glm::dvec3(1.0));
    if (target == glm::dvec3(1.0)) return {};

    // From grey to the colour in small steps: each starts near its answer.
    const double grey = std::clamp((target.r + target.g + target.b) / 3.0, 1e-3, 1.0 - 1e-3);
    glm::dvec3 c((grey - 0.5) / std::sqrt(grey * (1.0 - grey)), 0.0, 0.0);
    for (int step = 1; step <= 16; ++step) c = solve(glm::mix(glm::dvec3(grey), target, step / 16.0), c);

    Absorption absorption;
    for (int i = 0; i < kNodes; ++i) {
        absorption.nm.push_back(kBandMinNm + i * kStepNm);
        absorption.perM.push_back(-std::log(transmittance(c, i / (kNodes - 1.0))) / distanceM);
    }
    return absorption;
}

}  // namespace caustream::optics
