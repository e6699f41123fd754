// Blanchette 2012, section 6: sphere, ring, gem and bunny, each in a Cornell box lit by one spotlight.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "scenes/cornell_box.h"
#include "scenes/obj_reader.h"
#include "scenes/settings.h"

namespace caustream::scenes {

namespace {

double radians(double degrees) {
    return degrees * std::numbers::pi / 180.0;
}

// Low enough to look down on the floor, where the caustic is.
void addBoxCamera(GlbWriter& glb) {
    glb.addCamera("camera", {0.0, 1.35, 2.95}, {0.0, 0.46, 0.0}, 36.0);
}

// `ambient` and `exposureBiasEv` as in extras.caustream: how bright shadows are, and the whole picture.
void addRoom(GlbWriter& glb, double ambient = 0.10, double exposureBiasEv = 0.0) {
    addCornellBox(glb);
    glb.setSceneExtras({{"environment", {ambient, ambient, 1.1 * ambient}}, {"exposure_bias_ev", exposureBiasEv}});
    addBoxCamera(glb);
}

// A plane whose outward normal leans `slopeDeg` from straight up (`up` = 1) or down (-1), towards `azimuthDeg`.
glm::dvec4 facet(double up, double slopeDeg, double azimuthDeg, double offset) {
    const double t = radians(slopeDeg), p = radians(azimuthDeg);
    return {std::sin(t) * std::cos(p), up * std::cos(t), std::sin(t) * std::sin(p), offset};
}

// 24 faces, as the thesis's: a table, 8 stars, 8 mains, 6 pavilion facets and a culet. About one across. The pavilion
// is shallow enough that light from above leaves through it instead of being thrown back.
std::vector<glm::dvec4> gemPlanes() {
    constexpr double kStar = 24, kMain = 40, kPavilion = 35, kGirdle = 0.5, kTableHeight = 0.20, kCuletDepth = 0.31;
    std::vector<glm::dvec4> planes{facet(1, 0, 0, kTableHeight)};
    for (int i = 0; i < 8; ++i)
        planes.push_back(
            facet(1, kStar, 45 * i + 22.5, std::sin(radians(kStar)) * 0.27 + std::cos(radians(kStar)) * kTableHeight));
    for (int i = 0; i < 8; ++i) planes.push_back(facet(1, kMain, 45 * i, std::sin(radians(kMain)) * kGirdle));
    for (int i = 0; i < 6; ++i)
        planes.push_back(facet(-1, kPavilion, 60 * i + 10, std::sin(radians(kPavilion)) * kGirdle));
    planes.push_back(facet(-1, 0, 0, kCuletDepth));
    return planes;
}

}  // namespace

std::vector<std::uint8_t> makeSphere() {
    GlbWriter glb;
    addRoom(glb);
    const int glass = glb.addMaterial(glassMaterial("glass", 1.5168, {{"cauchy", {1.5046, 0.00420}}}));  // BK7
    glb.addMesh("sphere", icosphere(4, {0.0, 0.52, 0.0}, 0.36), glass);
    glb.addLight(spotLight("key", 60.0, 20.0, 27.0), {0.55, 1.92, -0.55}, {0.0, 0.42, 0.05});
    return glb.finish();
}

std::vector<std::uint8_t> makeRing() {
    GlbWriter glb;
    addRoom(glb);
    const int glass = glb.addMaterial(glassMaterial("ring", 1.62, {{"cauchy", {1.57, 0.018}}}));
    Mesh ring = torus(0.38, 0.12, 256, 128);  // 65,536 faces
    glm::mat4 place = glm::translate(glm::mat4(1.0f), {0.0f, 0.44f, -0.05f});
    place = glm::rotate(place, static_cast<float>(radians(18.0)), {1.0f, 0.0f, 0.25f});
    transform(ring, place);
    glb.addMesh("ring", ring, glass);
    glb.addLight(spotLight("key", 60.0, 22.0, 29.0), {0.55, 1.92, -0.6}, {0.0, 0.35, 0.05});
    return glb.finish();
}

std::vector<std::uint8_t> makeGem() {
    GlbWriter glb;
    addRoom(glb, 0.06, -0.3);  // dark, for the faint ends of the rainbows
    const int glass = glb.addMaterial(glassMaterial("gem", 1.587, {{"cauchy", {1.50, 0.03}}}));
    Mesh gem = convexPolyhedron(gemPlanes());
    glm::mat4 place = glm::translate(glm::mat4(1.0f), {0.0f, 0.62f, -0.05f});
    place = glm::rotate(place, static_cast<float>(radians(-8.0)), {0.0f, 0.0f, 1.0f});
    place = glm::rotate(place, static_cast<float>(radians(-12.0)), {1.0f, 0.0f, 0.0f});
    transform(gem, glm::scale(place, glm::vec3(0.85f)));
    glb.addMesh("gem", gem, glass);
    glb.addLight(spotLight("key", 60.0, 21.0, 29.0), {0.5, 1.92, -0.6}, {0.0, 0.5, 0.0});
    return glb.finish();
}

std::vector<std::uint8_t> makeBunny(const std::string& objPath) {
    GlbWriter glb;
    addRoom(glb);
    const int glass = glb.addMaterial(glassMaterial("bunny", 1.5168, {{"cauchy", {1.5046, 0.00420}}}));  // BK7
    Mesh bunny = readObj(objPath);
    glm::vec3 lo = bunny.positions.at(0), hi = lo;
    for (const glm::vec3& p : bunny.positions) lo = glm::min(lo, p), hi = glm::max(hi, p);
    // Standing on the floor, a hair above it so that no face lies in it.
    constexpr float kHeight = 0.95f, kGap = 0.002f;
    const float scale = kHeight / (hi.y - lo.y);
    glm::mat4 place = glm::translate(glm::mat4(1.0f), {0.0f, kGap, -0.15f});
    place = glm::rotate(place, static_cast<float>(radians(20.0)), {0.0f, 1.0f, 0.0f});
    place = glm::scale(place, glm::vec3(scale));
    transform(bunny, glm::translate(place, {-0.5f * (lo.x + hi.x), -lo.y, -0.5f * (lo.z + hi.z)}));
    smoothNormals(bunny);
    glb.addMesh("bunny", bunny, glass);
    glb.addLight(spotLight("key", 60.0, 24.0, 31.0), {0.6, 1.92, -0.75}, {0.0, 0.35, 0.0});
    return glb.finish();
}

}  // namespace caustream::scenes
