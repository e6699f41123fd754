// Small worlds for the reference tracer's tests.
#pragma once
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "bench/reference/tracer.h"
#include "scenes/mesh.h"

namespace caustream::tracer {

inline double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

inline Glass glassOf(double index, double perM = 0.0) {
    return {optics::ConstantIndex{index}, perM > 0.0 ? optics::Absorption{{380.0, 680.0}, {perM, perM}} : optics::Absorption{}};
}

inline Body bodyOf(const scenes::Mesh& mesh, int glass) {
    Body body{.indices = mesh.indices, .glass = glass};
    for (const glm::vec3& p : mesh.positions) body.positions.emplace_back(p);
    for (const glm::vec3& n : mesh.normals) body.normals.push_back(glm::normalize(glm::dvec3(n)));
    return body;
}

// A receiver, 2000 m wide, at height `y`.
inline Body floorAt(float y) { return bodyOf(scenes::quad({-1000, y, 1000}, {1000, y, 1000}, {1000, y, -1000}, {-1000, y, -1000}), -1); }

inline Light spot(const glm::dvec3& from, const glm::dvec3& direction, double halfAngleRad) {
    return {.type = scene::LightType::Spot, .position = from, .direction = glm::normalize(direction),
            .innerConeRad = halfAngleRad, .outerConeRad = halfAngleRad};
}

// As narrow as doubles allow, so that all photons take one way.
inline Light beam(const glm::dvec3& from, const glm::dvec3& direction) { return spot(from, direction, 1e-12); }

// The share of the light that lands within `halfM` of a point of a horizontal receiver; branches above a tenth only.
inline double shareAt(const World& world, const glm::dvec3& point, double halfM, Ledger* ledger = nullptr, double minWeight = 0.1) {
    Settings settings{.wavelengthsNm = {550.0}, .photons = 8, .minWeight = minWeight};
    settings.windows = {{point - glm::dvec3(halfM, 0, halfM), {2.0 * halfM, 0, 0}, {0, 0, 2.0 * halfM}, 1, 1, 1e-6}};
    const Result result = trace(world, settings);
    if (ledger) *ledger = result.ledgers[0];
    return static_cast<double>(result.windows[0].bands.values[0]) * 4.0 * halfM * halfM / result.ledgers[0].onCasters;
}

// Unpolarised reflectance from the angles (Fresnel 1823, sines and tangents), for comparison with the tracer's cosines.
inline double reflectance(double incidence, double nFrom, double nInto) {
    if (incidence == 0.0) return std::pow((nFrom - nInto) / (nFrom + nInto), 2.0);
    const double refracted = std::asin(nFrom / nInto * std::sin(incidence));
    const double s = std::sin(incidence - refracted) / std::sin(incidence + refracted);
    const double p = std::tan(incidence - refracted) / std::tan(incidence + refracted);
    return 0.5 * (s * s + p * p);
}

}  // namespace caustream::tracer
