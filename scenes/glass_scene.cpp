// Blanchette 2012, section 6: a glass on a wooden table; ours is full, and one body of glass and drink.
#include "scenes/glb_writer.h"
#include "scenes/settings.h"
#include "scenes/wood.h"

namespace caustream::scenes {

namespace {

constexpr int kAround = 96;  // with the profile below: about 12,000 faces, as the thesis's 12,137

// (radius, height) in metres, from the middle of the base outside to the middle of the drink's surface. Two curves: the
// surface of the drink meets the wall at an edge.
std::vector<Profile> glassProfile() {
    constexpr double kBaseRadius = 0.032, kRimRadius = 0.043, kHeight = 0.135, kWall = 0.003, kDrink = 0.122;
    Profile body{{0.0, 0.0}};
    lineTo(body, {kBaseRadius - 0.004, 0.0}, 6);
    bendTo(body, {kBaseRadius, 0.0}, {kBaseRadius + 0.0003, 0.004}, 6);
    bendTo(body, {0.036, 0.06}, {kRimRadius, kHeight - 0.0015}, 30);
    bendTo(body, {kRimRadius, kHeight}, {kRimRadius - 0.5 * kWall, kHeight}, 4);
    bendTo(body, {kRimRadius - kWall, kHeight}, {kRimRadius - kWall, kHeight - 0.0015}, 4);
    lineTo(body, {kRimRadius - kWall - 0.0008, kDrink}, 5);
    Profile surface{body.back()};
    lineTo(surface, {0.0, kDrink}, 8);
    return {body, surface};
}

}  // namespace

std::vector<std::uint8_t> makeGlass() {
    GlbWriter glb;
    // Amber: a third of blue and two thirds of green are left after 4 cm.
    nlohmann::json drink = glassMaterial("drink", 1.45, {{"cauchy", {1.435, 0.0050}}});
    drink["extensions"]["KHR_materials_volume"]["attenuationDistance"] = 0.06;
    drink["extensions"]["KHR_materials_volume"]["attenuationColor"] = {0.98, 0.62, 0.18};
    const int amber = glb.addMaterial(drink);
    nlohmann::json wood = matteMaterial("wood", {1.0f, 1.0f, 1.0f});
    wood["pbrMetallicRoughness"]["baseColorTexture"]["index"] = glb.addTexture(woodPng(1024, 768));
    const int table = glb.addMaterial(wood);
    const int wall = glb.addMaterial(matteMaterial("wall", {0.42f, 0.45f, 0.47f}));

    Mesh glass = lathe(glassProfile(), kAround);
    for (glm::vec3& p : glass.positions) p.y += 0.0003f;  // not in the table's plane
    glb.addMesh("glass", glass, amber);
    glb.addMesh("table", quad({-0.4f, 0, 0.3f}, {0.4f, 0, 0.3f}, {0.4f, 0, -0.3f}, {-0.4f, 0, -0.3f}), table);
    glb.addMesh("wall", quad({-1.2f, -0.6f, -0.45f}, {1.2f, -0.6f, -0.45f}, {1.2f, 1, -0.45f}, {-1.2f, 1, -0.45f}),
                wall);
    glb.addLight(spotLight("key", 8.0, 11.0, 17.0), {0.24, 0.46, -0.33}, {-0.03, 0.05, 0.03});
    glb.addCamera("camera", {0.0, 0.30, 0.50}, {-0.035, 0.03, 0.03}, 34.0);
    glb.setSceneExtras({{"environment", {0.14, 0.13, 0.12}}, {"exposure_bias_ev", 0.6}});
    return glb.finish();
}

}  // namespace caustream::scenes
