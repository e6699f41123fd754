// A ring of polished gold with a round sapphire, ten times its size, lying on a table: light from the side draws the curve
// of its inside on the table, and the stone throws its own.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "scenes/cuts.h"
#include "scenes/glb_writer.h"
#include "scenes/settings.h"

namespace caustream::scenes {

namespace {

constexpr double kInside = 0.088, kThick = 0.014, kHalfHeight = 0.024;   // m, of the band
constexpr double kStone = 0.036, kGirdleAt = 0.150;                      // the stone's radius, and how far out it is

void bendTo(Profile& curve, const glm::dvec2& control, const glm::dvec2& b, int segments) {
    const glm::dvec2 a = curve.back();
    for (int i = 1; i <= segments; ++i) {
        const double t = static_cast<double>(i) / segments;
        curve.push_back(glm::mix(glm::mix(a, control, t), glm::mix(control, b, t), t));
    }
}

// Around y: flat inside with rounded edges, bulging outside.
Mesh band() {
    constexpr double kEdge = 0.004;
    const double r = kInside, top = kHalfHeight;
    Profile curve{{r, -top + kEdge}};
    bendTo(curve, {r, -top}, {r + kEdge, -top}, 8);
    bendTo(curve, {r + kThick - 0.002, -top}, {r + kThick, -0.6 * top}, 10);
    bendTo(curve, {r + kThick + 0.003, 0.0}, {r + kThick, 0.6 * top}, 16);
    bendTo(curve, {r + kThick - 0.002, top}, {r + kEdge, top}, 10);
    bendTo(curve, {r, top}, {r, top - kEdge}, 8);
    Profile inside{curve.back()};
    bendTo(inside, {r, 0.0}, curve.front(), 6);
    return lathe({curve, inside}, 192);
}

// A rod with round ends.
Mesh rod(const glm::vec3& from, const glm::vec3& to, double radius) {
    const double length = glm::distance(from, to);
    Profile curve;
    constexpr int kArc = 6;
    for (int end = 0; end < 2; ++end) {
        for (int i = 0; i <= kArc; ++i) {
            const double angle = 0.5 * std::numbers::pi * (end == 0 ? i - kArc : i) / kArc;
            const bool pole = i == (end == 0 ? 0 : kArc);
            curve.emplace_back(pole ? 0.0 : radius * std::cos(angle), end * length + radius * std::sin(angle));
        }
    }
    Mesh mesh = lathe({curve}, 16);
    const glm::vec3 up = glm::normalize(to - from), side = glm::normalize(glm::cross(up, glm::vec3(0.3f, 0.5f, 0.8f)));
    transform(mesh, glm::mat4(glm::vec4(side, 0), glm::vec4(up, 0), glm::vec4(glm::cross(side, up), 0), glm::vec4(from, 1)));
    return mesh;
}

// Six claws that hold the stone, whose axis is x.
Mesh setting() {
    Mesh mesh = torus(0.019, 0.004, 48, 16);
    transform(mesh, glm::rotate(glm::translate(glm::mat4(1.0f), {0.106f, 0.0f, 0.0f}), glm::radians(90.0f), {0.0f, 0.0f, 1.0f}));
    for (int i = 0; i < 6; ++i) {
        const float angle = glm::radians(60.0f * static_cast<float>(i) + 11.0f);
        const glm::vec3 out(0.0f, std::cos(angle), std::sin(angle));
        append(mesh, rod(glm::vec3(0.100f, 0, 0) + 0.017f * out, glm::vec3(0.156f, 0, 0) + 0.0365f * out, 0.0032));
    }
    return mesh;
}

}  // namespace

std::vector<std::uint8_t> makeJewel() {
    GlbWriter glb;
    const int gold = glb.addMaterial(metalMaterial("gold", {1.0f, 0.77f, 0.34f}));
    // Sapphire, ordinary ray: Malitson 1962, Refraction and Dispersion of Synthetic Sapphire
    nlohmann::json corundum = glassMaterial(
        "sapphire", 1.768, {{"sellmeier", {1.4313493, 0.65054713, 5.3414021, 0.0052799261, 0.0142382647, 325.017834}}});
    corundum["extensions"]["KHR_materials_volume"]["attenuationDistance"] = 0.08;
    corundum["extensions"]["KHR_materials_volume"]["attenuationColor"] = {0.16, 0.30, 0.86};
    const int sapphire = glb.addMaterial(corundum);
    const int table = glb.addMaterial(matteMaterial("table", {0.62f, 0.60f, 0.58f}));
    const int wall = glb.addMaterial(matteMaterial("wall", {0.30f, 0.31f, 0.36f}));

    Mesh ring = band(), stone = convexPolyhedron(brilliantPlanes());
    append(ring, setting());
    transform(stone, glm::scale(glm::rotate(glm::translate(glm::mat4(1.0f), {static_cast<float>(kGirdleAt), 0.0f, 0.0f}),
                                            glm::radians(-90.0f), {0.0f, 0.0f, 1.0f}), glm::vec3(static_cast<float>(kStone))));
    // It rests on a claw and on the far edge of the band.
    const glm::mat4 place = glm::rotate(glm::rotate(glm::translate(glm::mat4(1.0f), {0.03f, 0.0325f, 0.0f}), glm::radians(218.0f), {0.0f, 1.0f, 0.0f}),
                                        glm::radians(4.2f), {0.0f, 0.0f, 1.0f});
    transform(ring, place);
    transform(stone, place);
    glb.addMesh("ring", ring, gold);
    glb.addMesh("stone", stone, sapphire);
    glb.addMesh("table", quad({-1.2f, 0, 0.9f}, {1.2f, 0, 0.9f}, {1.2f, 0, -0.7f}, {-1.2f, 0, -0.7f}), table);
    glb.addMesh("wall", quad({-2.0f, -0.6f, -0.8f}, {2.0f, -0.6f, -0.8f}, {2.0f, 1.2f, -0.8f}, {-2.0f, 1.2f, -0.8f}), wall);
    glb.addLight(spotLight("key", 40.0, 11.0, 16.0), {-1.05, 0.52, -0.10}, {-0.045, 0.03, 0.05});
    glb.addCamera("camera", {-0.03, 0.44, 0.50}, {-0.005, 0.015, 0.01}, 31.0);
    glb.setSceneExtras({{"environment", {0.10, 0.10, 0.11}}, {"exposure_bias_ev", 0.6}});
    return glb.finish();
}

}  // namespace caustream::scenes
