#include "scenes/builtin.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "scenes/cornell_box.h"
#include "scenes/glb_writer.h"

namespace caustream::scenes {

namespace {

// Blanchette 2012: the sphere is an icosphere of 5,120 faces.
std::vector<std::uint8_t> sphere() {
    GlbWriter glb;
    addCornellBox(glb);
    const int glass = glb.addMaterial(glassMaterial("glass", 1.5168, {{"cauchy", {1.5046, 0.00420}}}));
    glb.addMesh("sphere", icosphere(4, {0.0, 0.55, 0.0}, 0.3), glass);
    glb.addLight(spotLight("key", 60.0, 24.0, 30.0), {0.45, 1.9, -0.4}, {0.0, 0.45, 0.0});
    glb.addCamera("camera", {0.0, 1.0, 3.4}, {0.0, 0.75, 0.0}, 36.0);
    return glb.finish();
}

// A plane whose outward normal leans `slopeDeg` from straight up (`up` = 1) or down (-1), towards `azimuthDeg`.
glm::dvec4 facet(double up, double slopeDeg, double azimuthDeg, double offset) {
    const double t = slopeDeg * std::numbers::pi / 180.0, p = azimuthDeg * std::numbers::pi / 180.0;
    return {std::sin(t) * std::cos(p), up * std::cos(t), std::sin(t) * std::sin(p), offset};
}

// 24 faces, as the thesis's: a table, 8 stars, 8 mains, 6 pavilion facets and a culet.
std::vector<glm::dvec4> gemPlanes() {
    const auto sine = [](double deg) { return std::sin(deg * std::numbers::pi / 180.0); };
    const auto cosine = [](double deg) { return std::cos(deg * std::numbers::pi / 180.0); };
    std::vector<glm::dvec4> planes{facet(1, 0, 0, 0.20)};
    for (int i = 0; i < 8; ++i) planes.push_back(facet(1, 24, 45 * i + 22.5, sine(24) * 0.27 + cosine(24) * 0.20));
    for (int i = 0; i < 8; ++i) planes.push_back(facet(1, 40, 45 * i, sine(40) * 0.5));
    for (int i = 0; i < 6; ++i) planes.push_back(facet(-1, 38, 60 * i + 10, sine(38) * 0.5));
    planes.push_back(facet(-1, 0, 0, 0.33));
    return planes;
}

std::vector<std::uint8_t> gem() {
    GlbWriter glb;
    addCornellBox(glb);
    const int glass = glb.addMaterial(glassMaterial("gem", 1.68, {{"cauchy", {1.6, 0.03}}}));
    Mesh mesh = convexPolyhedron(gemPlanes());
    const float size = 0.8f;
    transform(mesh, glm::mat4(size, 0, 0, 0, 0, size, 0, 0, 0, 0, size, 0, 0, 0.6f, 0, 1));
    glb.addMesh("gem", mesh, glass);
    glb.addLight(spotLight("key", 60.0, 24.0, 30.0), {0.5, 1.9, -0.4}, {0.0, 0.5, 0.0});
    glb.addCamera("camera", {0.0, 1.0, 3.4}, {0.0, 0.75, 0.0}, 36.0);
    return glb.finish();
}

}  // namespace

std::vector<std::uint8_t> makeBuiltin(const std::string& name) {
    if (name == "sphere") return sphere();
    if (name == "gem") return gem();
    throw std::runtime_error("no scene is called \"" + name + "\"");
}

}  // namespace caustream::scenes
