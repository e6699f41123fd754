// Cut stones, some thirty times their size, on a table in a dark room: what they throw is their fire.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/cuts.h"
#include "scenes/glb_writer.h"
#include "scenes/settings.h"

namespace caustream::scenes {

namespace {

void addTable(GlbWriter& glb) {
    const int table = glb.addMaterial(matteMaterial("table", {0.55f, 0.54f, 0.52f}));
    const int wall = glb.addMaterial(matteMaterial("wall", {0.46f, 0.46f, 0.50f}));
    glb.addMesh("table", quad({-1.6f, 0, 1.1f}, {1.6f, 0, 1.1f}, {1.6f, 0, -0.8f}, {-1.6f, 0, -0.8f}), table);
    glb.addMesh("wall", quad({-1.6f, 0, -0.8f}, {1.6f, 0, -0.8f}, {1.6f, 1.4f, -0.8f}, {-1.6f, 1.4f, -0.8f}), wall);
}

// `leanDeg` from upright towards +x, then turned about the vertical; standing a hair above the table.
Mesh placed(const std::vector<glm::dvec4>& planes, double radius, double leanDeg, double turnDeg, const glm::vec3& at) {
    Mesh stone = convexPolyhedron(planes);
    glm::mat4 place = glm::translate(glm::mat4(1.0f), at);
    place = glm::rotate(place, glm::radians(static_cast<float>(turnDeg)), {0.0f, 1.0f, 0.0f});
    place = glm::rotate(place, glm::radians(static_cast<float>(-leanDeg)), {0.0f, 0.0f, 1.0f});
    transform(stone, glm::scale(place, glm::vec3(static_cast<float>(radius))));
    standAt(stone, 0.0005);
    return stone;
}

}  // namespace

std::vector<std::uint8_t> makeBrilliant() {
    GlbWriter glb;
    addTable(glb);
    // Peter 1923, Ueber Brechungsindizes und Absorptionskonstanten des Diamanten, Z. Physik 15, 358
    const int diamond = glb.addMaterial(
        glassMaterial("diamond", 2.4175, {{"sellmeier", {0.3306, 4.3356, 0.0, 0.030625, 0.011236, 0.0}}}));
    // It lies on a pavilion main, as a loose stone does, the crown towards the light.
    const glm::vec3 at(0.18f, 0.0f, -0.1f);
    glb.addMesh("brilliant", placed(brilliantPlanes(), 0.12, 40.75, 210.0, at), diamond);
    glb.addLight(spotLight("key", 60.0, 5.2, 6.2), {-0.79, 0.89, 0.72}, {0.18, 0.09, -0.1});
    glb.addCamera("camera", {-0.05, 0.62, 1.15}, {-0.08, 0.06, 0.0}, 36.0);
    glb.setSceneExtras({{"environment", {0.012, 0.012, 0.014}}, {"exposure_bias_ev", 2.2}});
    return glb.finish();
}

std::vector<std::uint8_t> makeEmerald() {
    GlbWriter glb;
    addTable(glb);
    // Beryl: n_D 1.58 and n_F - n_C .009 (Anderson 1980, Gem Testing), so an Abbe number of 64.
    nlohmann::json beryl = glassMaterial("emerald", 1.58, nullptr);
    beryl["extensions"]["KHR_materials_dispersion"]["dispersion"] = 20.0 / 64.0;
    beryl["extensions"]["KHR_materials_volume"]["attenuationDistance"] = 0.4;
    beryl["extensions"]["KHR_materials_volume"]["attenuationColor"] = {0.10, 0.72, 0.34};
    const int emerald = glb.addMaterial(beryl);
    // On the middle step of a long side.
    glb.addMesh("emerald", placed(emeraldPlanes(), 0.16, 47.0, 212.0, {0.16f, 0.0f, -0.08f}), emerald);
    glb.addLight(spotLight("key", 60.0, 7.5, 9.0), {-0.68, 0.86, 0.55}, {0.16, 0.09, -0.08});
    glb.addCamera("camera", {0.00, 0.58, 0.98}, {0.07, 0.09, -0.1}, 36.0);
    glb.setSceneExtras({{"environment", {0.02, 0.022, 0.022}}, {"exposure_bias_ev", 1.7}});
    return glb.finish();
}

}  // namespace caustream::scenes
