// Newton's experiment: a narrow beam meets a flint prism at minimum deviation and leaves it as a rainbow, which runs
// along the floor and climbs a screen.
#include <cmath>
#include <numbers>

#include "scenes/glb_writer.h"
#include "scenes/settings.h"

namespace caustream::scenes {

namespace {

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

glm::dvec3 level(double elevation) { return {std::cos(elevation), std::sin(elevation), 0.0}; }

}  // namespace

std::vector<std::uint8_t> makePrism() {
    // In the x-y plane. Middle colour leaves downwards at `out`; the rest follows from minimum deviation: the beam comes
    // in at out + deviation and passes the prism square to the plane that halves its apex.
    constexpr double kSide = 0.22, kHalfLength = 0.16, kHeight = 0.62, kBeamM = 0.75;
    constexpr double kIndex = 1.7945;  // SF11 at 540 nm
    const double apex = radians(60.0), incidence = std::asin(kIndex * std::sin(0.5 * apex));
    const double out = radians(-21.0), in = out + 2.0 * incidence - apex, inside = 0.5 * (in + out);
    const glm::dvec3 centre(-0.75, kHeight, 0.0);

    std::vector<glm::dvec4> planes{{0, 0, 1, kHalfLength}, {0, 0, -1, kHalfLength}};
    const double inradius = kSide / (2.0 * std::sqrt(3.0));
    for (double turn : {90.0 + 60.0, 90.0 - 60.0, -90.0}) {  // entry, exit, base
        const glm::dvec3 normal = level(inside + radians(turn));
        planes.emplace_back(normal, inradius + glm::dot(normal, centre));
    }

    GlbWriter glb;
    const int flint = glb.addMaterial(glassMaterial(
        "flint", 1.7847, {{"sellmeier", {1.73848403, 0.311168974, 1.17490871, 0.0136068604, 0.0615960463, 121.922711}}}));
    const int white = glb.addMaterial(matteMaterial("screen", {0.85f, 0.85f, 0.85f}));
    const int dark = glb.addMaterial(matteMaterial("wall", {0.30f, 0.30f, 0.32f}));
    glb.addMesh("prism", convexPolyhedron(planes), flint);
    constexpr float kFront = 0.9f, kBack = -0.7f, kLeft = -1.7f, kScreen = 0.95f;
    glb.addMesh("floor", quad({kLeft, 0, kFront}, {kScreen, 0, kFront}, {kScreen, 0, kBack}, {kLeft, 0, kBack}), white);
    glb.addMesh("screen", quad({kScreen, 0, kBack}, {kScreen, 0, kFront}, {kScreen, 0.9f, kFront}, {kScreen, 0.9f, kBack}), white);
    glb.addMesh("back wall", quad({kLeft, 0, kBack}, {kScreen, 0, kBack}, {kScreen, 1.4f, kBack}, {kLeft, 1.4f, kBack}), dark);

    const glm::dvec3 entry = centre + inradius * level(inside + radians(150.0));
    glb.addLight(spotLight("key", 300.0, 0.65, 0.75), entry - kBeamM * level(in), entry);
    glb.addCamera("camera", {-0.35, 1.25, 1.85}, {0.0, 0.22, 0.0}, 40.0);
    glb.setSceneExtras({{"environment", {0.02, 0.02, 0.025}}});
    return glb.finish();
}

}  // namespace caustream::scenes
