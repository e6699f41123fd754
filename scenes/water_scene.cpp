// A tumbler of water in low light. Glass and water overlap by half the wall: between them there is one surface, the
// glass's, as the higher priority says, and no sliver of air.
#include <glm/common.hpp>

#include "scenes/glb_writer.h"
#include "scenes/settings.h"

namespace caustream::scenes {

namespace {

constexpr int kAround = 128;
constexpr double kFoot = 0.029, kRim = 0.036, kHeight = 0.105, kWall = 0.0024, kBase = 0.011;   // m
constexpr double kFull = 0.078;   // height of the water

// Radius of the outer wall at a height.
double outer(double y) { return glm::mix(kFoot, kRim, y / kHeight); }

// From the middle of the foot outside, over the rim, to the middle of the bottom inside.
std::vector<Profile> tumbler() {
    Profile curve{{0.0, 0.0}};
    lineTo(curve, {kFoot - 0.004, 0.0}, 6);
    bendTo(curve, {kFoot, 0.0}, {outer(0.004), 0.004}, 8);
    lineTo(curve, {outer(kHeight - 0.0012), kHeight - 0.0012}, 24);
    bendTo(curve, {kRim, kHeight}, {kRim - 0.5 * kWall, kHeight}, 5);
    bendTo(curve, {kRim - kWall, kHeight}, {outer(kHeight - 0.0012) - kWall, kHeight - 0.0012}, 5);
    lineTo(curve, {outer(kBase + 0.008) - kWall, kBase + 0.008}, 24);
    bendTo(curve, {outer(kBase) - kWall, kBase}, {outer(kBase) - kWall - 0.009, kBase}, 10);
    lineTo(curve, {0.0, kBase}, 6);
    return {curve};
}

// Its side and bottom run inside the glass.
std::vector<Profile> water() {
    const auto side = [](double y) { return outer(y) - 0.5 * kWall; };
    Profile body{{0.0, 0.5 * kBase}};
    lineTo(body, {side(kBase) - 0.004, 0.5 * kBase}, 6);
    bendTo(body, {side(kBase), 0.5 * kBase}, {side(kBase + 0.002), kBase + 0.002}, 6);
    lineTo(body, {side(kFull), kFull}, 16);
    Profile surface{body.back()};
    lineTo(surface, {0.0, kFull}, 8);
    return {body, surface};
}

Mesh standing(const std::vector<Profile>& curves) {
    Mesh mesh = lathe(curves, kAround);
    for (glm::vec3& p : mesh.positions) p.y += 0.0003f;   // not in the table's plane
    return mesh;
}

}  // namespace

std::vector<std::uint8_t> makeWater() {
    GlbWriter glb;
    // Soda-lime glass: n_d 1.52, Abbe number 59
    const int glass = glb.addMaterial(glassMaterial("glass", 1.52, {{"cauchy", {1.5076, 0.0042}}, {"priority", 1}}));
    // Through n_F 1.3371 and n_C 1.3312 at 20 degrees C
    const int drink = glb.addMaterial(glassMaterial("water", 1.333, {{"cauchy", {1.3240, 0.0031}}, {"priority", 0}}));
    const int table = glb.addMaterial(matteMaterial("table", {0.70f, 0.67f, 0.62f}));
    const int wall = glb.addMaterial(matteMaterial("wall", {0.33f, 0.38f, 0.42f}));
    glb.addMesh("glass", standing(tumbler()), glass);
    glb.addMesh("water", standing(water()), drink);
    glb.addMesh("table", quad({-0.6f, 0, 0.45f}, {0.6f, 0, 0.45f}, {0.6f, 0, -0.35f}, {-0.6f, 0, -0.35f}), table);
    glb.addMesh("wall", quad({-1.4f, -0.6f, -0.45f}, {1.4f, -0.6f, -0.45f}, {1.4f, 1, -0.45f}, {-1.4f, 1, -0.45f}), wall);
    glb.addLight(spotLight("key", 12.0, 9.0, 14.0), {0.42, 0.36, -0.33}, {-0.01, 0.05, 0.01});
    glb.addCamera("camera", {-0.02, 0.25, 0.43}, {-0.045, 0.035, 0.02}, 34.0);
    glb.setSceneExtras({{"environment", {0.12, 0.12, 0.12}}, {"exposure_bias_ev", 0.3}});
    return glb.finish();
}

}  // namespace caustream::scenes
