// Newton's experiment: a beam meets a bar of flint near minimum deviation and leaves it as a rainbow on a white floor.
#include <cmath>
#include <numbers>

#include "scenes/glb_writer.h"
#include "scenes/settings.h"

namespace caustream::scenes {

namespace {

double radians(double degrees) {
    return degrees * std::numbers::pi / 180.0;
}

glm::dvec3 level(double elevation) {
    return {std::cos(elevation), std::sin(elevation), 0.0};
}

}  // namespace

std::vector<std::uint8_t> makePrism() {
    // In the x-y plane, the apex up. A little off minimum deviation (63 degrees of incidence) towards a grazing exit,
    // which spreads the colours over 15 degrees instead of 11. Green leaves downwards at `out`; the rest follows.
    constexpr double kApexDeg = 60.0, kIncidenceDeg = 61.5, kOutDeg = -43.0;
    constexpr double kIndex = 1.7945;  // SF11 at 540 nm
    constexpr double kSide = 0.10, kHalfLength = 0.14, kBeamM = 0.9;
    const double apex = radians(kApexDeg), incidence = radians(kIncidenceDeg);
    const double refracted = std::asin(std::sin(incidence) / kIndex);
    const double exit = std::asin(kIndex * std::sin(apex - refracted));
    const double in = radians(kOutDeg) + incidence + exit - apex;
    const double entryNormal = in + std::numbers::pi - incidence;  // elevation of the entry face's outward normal
    const glm::dvec3 centre(-0.62, 0.72, 0.0);

    std::vector<glm::dvec4> planes{{0, 0, 1, kHalfLength}, {0, 0, -1, kHalfLength}};
    const double inradius = kSide / (2.0 * std::sqrt(3.0));
    for (int face = 0; face < 3; ++face) {  // entry, exit, base: the normals are 120 degrees apart
        const glm::dvec3 normal = level(entryNormal - radians(120.0 * face));
        planes.emplace_back(normal, inradius + glm::dot(normal, centre));
    }

    GlbWriter glb;
    const int flint = glb.addMaterial(
        glassMaterial("flint", 1.7847,
                      {{"sellmeier", {1.73848403, 0.311168974, 1.17490871, 0.0136068604, 0.0615960463, 121.922711}}}));
    const int white = glb.addMaterial(matteMaterial("screen", {0.85f, 0.85f, 0.85f}));
    const int dark = glb.addMaterial(matteMaterial("wall", {0.42f, 0.42f, 0.45f}));
    glb.addMesh("prism", convexPolyhedron(planes), flint);
    constexpr float kFront = 0.8f, kBack = -0.6f, kLeft = -1.2f, kRight = 1.2f, kHeight = 1.3f;
    glb.addMesh("floor", quad({kLeft, 0, kFront}, {kRight, 0, kFront}, {kRight, 0, kBack}, {kLeft, 0, kBack}), white);
    glb.addMesh("back wall",
                quad({kLeft, 0, kBack}, {kRight, 0, kBack}, {kRight, kHeight, kBack}, {kLeft, kHeight, kBack}), dark);

    const glm::dvec3 entry = centre + inradius * level(entryNormal);
    glb.addLight(spotLight("key", 300.0, 9.0, 9.5), entry - kBeamM * level(in), entry);
    glb.addCamera("camera", {-0.30, 1.0, 1.45}, {-0.16, 0.34, 0.0}, 38.0);
    glb.setSceneExtras({{"environment", {0.013, 0.013, 0.015}}, {"exposure_bias_ev", 2.5}});
    return glb.finish();
}

}  // namespace caustream::scenes
