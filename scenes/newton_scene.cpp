// Newton's second prism (Opticks, 1704, book one, proposition II, experiment 6), laid flat on a table as schools do: a
// sheet of white light skims the table and draws its own way on it. The first prism spreads it, a board with a slit lets
// one colour through, and the second prism bends that colour back and spreads it no further.
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "scenes/glb_writer.h"
#include "scenes/png.h"
#include "scenes/settings.h"

namespace caustream::scenes {

namespace {

constexpr double kIndex = 1.7945;   // SF11 at 540 nm
constexpr double kSide = 0.07, kPrismM = 0.09;

double radians(double degrees) {
    return degrees * std::numbers::pi / 180.0;
}

// On the table, counter-clockwise from +x seen from above.
glm::dvec3 level(double heading) {
    return {std::cos(heading), 0.0, -std::sin(heading)};
}

struct Way {   // of green light along the table
    glm::dvec3 point{0.0};
    double heading = 0.0;
    glm::dvec3 after(double m) const { return point + m * level(heading); }
};

// An upright prism that the way meets in the middle of a face, near minimum deviation. `turn` 1: clockwise seen from above,
// -1: the other way.
Way addPrism(GlbWriter& glb, const std::string& name, int flint, const Way& in, double turn) {
    constexpr double kIncidenceDeg = 61.5;
    const double incidence = radians(kIncidenceDeg), refracted = std::asin(std::sin(incidence) / kIndex);
    const double entryNormal = in.heading + std::numbers::pi - turn * incidence, inradius = kSide / (2.0 * std::sqrt(3.0));
    const glm::dvec3 centre = in.point - inradius * level(entryNormal);
    std::vector<glm::dvec4> planes{{0, 1, 0, kPrismM}, {0, -1, 0, -0.0005}};   // not in the table's plane
    for (int face = 0; face < 3; ++face) {
        const glm::dvec3 normal = level(entryNormal - turn * radians(120.0 * face));
        planes.emplace_back(normal, inradius + glm::dot(normal, centre));
    }
    glb.addMesh(name, convexPolyhedron(planes), flint);

    const double within = in.heading - turn * (incidence - refracted);
    const glm::dvec3 exitNormal = level(entryNormal - turn * radians(120.0)), direction = level(within);
    const double chord = (inradius - glm::dot(exitNormal, in.point - centre)) / glm::dot(exitNormal, direction);
    const double exit = std::asin(kIndex * std::sin(radians(60.0) - refracted));
    return {in.point + chord * direction, in.heading - turn * (incidence + exit - radians(60.0))};
}

// Upright, across a way, from `leftM` to `rightM` of it.
void addBoard(GlbWriter& glb, const std::string& name, int material, const Way& at, double leftM, double rightM) {
    constexpr float kHalfThickM = 0.0015f, kHighM = 0.085f;
    Mesh board = box({-kHalfThickM, 0.0f, static_cast<float>(leftM)}, {kHalfThickM, kHighM, static_cast<float>(rightM)});
    transform(board, glm::rotate(glm::translate(glm::mat4(1.0f), glm::vec3(at.point)), static_cast<float>(at.heading), {0.0f, 1.0f, 0.0f}));
    glb.addMesh(name, board, material);
}

// White on black: an upright slit.
std::vector<std::uint8_t> slitCookie() {
    constexpr int kSize = 128, kHalfOpen = 5;
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < kSize * kSize; ++i) texels.insert(texels.end(), 3, std::abs(2 * (i % kSize) + 1 - kSize) < 2 * kHalfOpen ? 255 : 0);
    return encodePng(kSize, kSize, texels);
}

}  // namespace

std::vector<std::uint8_t> makeNewton() {
    GlbWriter glb;
    const int flint = glb.addMaterial(
        glassMaterial("flint", 1.7847,
                      {{"sellmeier", {1.73848403, 0.311168974, 1.17490871, 0.0136068604, 0.0615960463, 121.922711}}}));
    const int white = glb.addMaterial(matteMaterial("table", {0.85f, 0.85f, 0.85f}));
    const int grey = glb.addMaterial(matteMaterial("board", {0.55f, 0.55f, 0.58f})), black = glb.addMaterial(matteMaterial("card", {0.03f, 0.03f, 0.03f}));

    const Way in{{-0.16, 0.0, -0.14}, 0.0};
    const Way spread = addPrism(glb, "first prism", flint, in, 1.0);
    constexpr double kHalfOpenM = 0.0035, kBoardM = 0.05;
    const Way slitAt{spread.after(0.16), spread.heading}, one{spread.after(0.34), spread.heading};
    addBoard(glb, "left board", grey, slitAt, -kHalfOpenM - kBoardM, -kHalfOpenM);
    addBoard(glb, "right board", grey, slitAt, kHalfOpenM, kHalfOpenM + kBoardM);
    addPrism(glb, "second prism", flint, one, -1.0);
    // Cards that catch what the prisms' faces throw back.
    addBoard(glb, "card behind", black, {in.point + glm::dvec3(0.06, 0.0, -0.07), radians(57.0)}, -0.05, 0.05);
    addBoard(glb, "card before", black, {in.point + glm::dvec3(-0.10, 0.0, 0.01), 0.0}, 0.0, 0.05);
    addBoard(glb, "card beside", black, {one.point + glm::dvec3(-0.05, 0.0, 0.07), radians(236.0)}, -0.04, 0.04);
    glb.addMesh("table", quad({-1.0f, 0, 1.0f}, {1.0f, 0, 1.0f}, {1.0f, 0, -0.6f}, {-1.0f, 0, -0.6f}), white);

    nlohmann::json slit = spotLight("key", 60.0, 1.5, 1.5);
    slit["extras"]["caustream"]["cookie"] = glb.addTexture(slitCookie());
    constexpr double kLightM = 1.5, kAimM = 0.03, kDownDeg = 4.0;
    const glm::dvec3 aim = in.point + glm::dvec3(0.0, kAimM, 0.0);
    glb.addLight(slit, aim + kLightM * glm::dvec3(-1.0, std::tan(radians(kDownDeg)), 0.0), aim);
    glb.addCamera("camera", {0.08, 0.66, 0.46}, {0.06, 0.0, 0.025}, 40.0);
    glb.setSceneExtras({{"environment", {0.0007, 0.0007, 0.0008}}, {"exposure_bias_ev", 4.5}});
    return glb.finish();
}

}  // namespace caustream::scenes
