#include "scenes/cuts.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>

namespace caustream::scenes {

namespace {

constexpr double radians(double degrees) {
    return degrees * std::numbers::pi / 180.0;
}

glm::dvec3 cylindrical(double radius, double azimuthDeg, double y) {
    const double a = radians(azimuthDeg);
    return {radius * std::cos(a), y, radius * std::sin(a)};
}

// The plane through three points, the origin within.
glm::dvec4 through(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    glm::dvec3 n = glm::normalize(glm::cross(b - a, c - a));
    if (glm::dot(n, a) < 0.0) n = -n;
    return {n, glm::dot(n, a)};
}

}  // namespace

std::vector<glm::dvec4> brilliantPlanes() {
    constexpr double kTable = 0.53, kGirdle = 0.02;   // radius to the table's corners; half the girdle's height
    constexpr double kStar = 0.5, kLowerHalf = 0.77;  // of the way from table to girdle, and from girdle to culet
    constexpr double kCulet = 0.015;
    const double crown = std::tan(radians(34.5)), pavilion = std::tan(radians(40.75)), slant = std::cos(radians(22.5));
    const double table = kGirdle + (1.0 - kTable) * crown;
    // Where two neighbouring mains meet, between them
    const double tip = std::lerp(kTable * slant, 1.0, kStar), tail = 1.0 - kLowerHalf;
    const double tipY = kGirdle + (1.0 - tip * slant) * crown, tailY = -kGirdle - (1.0 - tail * slant) * pavilion;

    std::vector<glm::dvec4> planes{{0, 1, 0, table}, {0, -1, 0, kGirdle + (1.0 - kCulet) * pavilion}};
    for (int i = 0; i < 8; ++i) {
        const double main = 45.0 * i, between = main + 22.5;
        const glm::dvec3 top = cylindrical(1.0, main, kGirdle), bottom = cylindrical(1.0, main, -kGirdle);
        const glm::dvec3 along = cylindrical(1.0, main + 90.0, 0.0);
        planes.push_back(through(top, top + along, cylindrical(kTable, main, table)));
        planes.push_back(through(bottom, bottom + along, {0.0, -kGirdle - pavilion, 0.0}));
        planes.push_back(through(cylindrical(kTable, main, table), cylindrical(kTable, main + 45.0, table), cylindrical(tip, between, tipY)));
        for (const double side : {main - 22.5, main + 22.5}) {
            const glm::dvec3 corner = cylindrical(1.0, side, kGirdle), under = cylindrical(1.0, side, -kGirdle);
            planes.push_back(through(top, corner, cylindrical(tip, side, tipY)));
            planes.push_back(through(bottom, under, cylindrical(tail, side, tailY)));
            planes.push_back(through(top, corner, bottom));
        }
    }
    return planes;
}

std::vector<glm::dvec4> emeraldPlanes() {
    constexpr double kLength = 1.0, kWidth = 0.72, kCorner = 0.99, kGirdle = 0.025;   // distances of the sides
    struct Step {
        double slopeDeg, inset;   // from the horizontal; how far it reaches inwards
    };
    constexpr std::array<Step, 3> kCrown{{{46, 0.10}, {38, 0.12}, {29, 0.12}}};
    constexpr std::array<Step, 3> kPavilion{{{56, 0.17}, {47, 0.22}, {40, 1.0}}};
    std::vector<glm::dvec4> planes;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 out = cylindrical(1.0, 45.0 * i, 0.0);
        const double distance = i % 2 == 1 ? kCorner : i % 4 == 2 ? kLength : kWidth;
        planes.emplace_back(out, distance);
        const auto addSteps = [&](const std::array<Step, 3>& steps, double up) {
            double inset = 0.0, y = up * kGirdle;
            for (const Step& step : steps) {
                const double slope = radians(step.slopeDeg);
                const glm::dvec3 normal = std::sin(slope) * out + glm::dvec3(0.0, up * std::cos(slope), 0.0);
                planes.emplace_back(normal, glm::dot(normal, (distance - inset) * out + glm::dvec3(0.0, y, 0.0)));
                inset += step.inset, y += up * step.inset * std::tan(slope);
            }
            return y;
        };
        const double table = addSteps(kCrown, 1.0);
        addSteps(kPavilion, -1.0);
        if (i == 0) planes.emplace_back(0, 1, 0, table);
    }
    return planes;
}

}  // namespace caustream::scenes
