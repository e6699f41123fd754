// A ball lens on a table. Its paraxial focus lies n R / (2 (n - 1)) from the centre: the light stands as high as that
// distance needs to end on the table, so the picture is the focus with the colours and the spherical error around it.
#include <cmath>
#include <glm/geometric.hpp>

#include "scenes/glb_writer.h"
#include "scenes/settings.h"

namespace caustream::scenes {

std::vector<std::uint8_t> makeBall() {
    constexpr double kRadius = 0.05, kIndex = 1.5187, kLightM = 0.75;   // N-BK7 at 546 nm
    GlbWriter glb;
    const int glass = glb.addMaterial(glassMaterial(
        "glass", 1.5168, {{"sellmeier", {1.03961212, 0.231792344, 1.01046945, 0.00600069867, 0.0200179144, 103.560653}}}));  // N-BK7, Schott
    const int table = glb.addMaterial(matteMaterial("table", {0.66f, 0.64f, 0.60f}));
    const int wall = glb.addMaterial(matteMaterial("wall", {0.30f, 0.34f, 0.40f}));
    const glm::dvec3 centre(0.03, kRadius + 0.0003, -0.02);   // not in the table's plane
    glb.addMesh("ball", icosphere(5, centre, kRadius), glass);
    glb.addMesh("table", quad({-0.6f, 0, 0.45f}, {0.6f, 0, 0.45f}, {0.6f, 0, -0.4f}, {-0.6f, 0, -0.4f}), table);
    glb.addMesh("wall", quad({-1.2f, -0.5f, -0.5f}, {1.2f, -0.5f, -0.5f}, {1.2f, 1, -0.5f}, {-1.2f, 1, -0.5f}), wall);

    const double sine = 2.0 * (kIndex - 1.0) / kIndex, cosine = std::sqrt(1.0 - sine * sine);
    const glm::dvec3 towards = cosine * glm::normalize(glm::dvec3(0.75, 0.0, -0.66)) + glm::dvec3(0.0, sine, 0.0);
    glb.addLight(spotLight("key", 30.0, 9.0, 14.0), centre + kLightM * towards, centre);
    glb.addCamera("camera", {-0.03, 0.24, 0.36}, {-0.015, 0.028, 0.0}, 34.0);
    glb.setSceneExtras({{"environment", {0.10, 0.10, 0.11}}, {"exposure_bias_ev", 0.0}});
    return glb.finish();
}

}  // namespace caustream::scenes
