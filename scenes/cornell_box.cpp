#include "scenes/cornell_box.h"

namespace caustream::scenes {

void addCornellBox(GlbWriter& glb) {
    constexpr float kHalf = 1.0f, kHeight = 2.0f;
    const int grey = glb.addMaterial(matteMaterial("white wall", {0.73f, 0.73f, 0.73f}));
    const int red = glb.addMaterial(matteMaterial("red wall", {0.63f, 0.06f, 0.05f}));
    const int green = glb.addMaterial(matteMaterial("green wall", {0.12f, 0.45f, 0.09f}));

    const auto at = [&](int x, int y, int z) {
        return glm::vec3(x ? kHalf : -kHalf, y ? kHeight : 0, z ? kHalf : -kHalf);
    };
    glb.addMesh("floor", quad(at(0, 0, 1), at(1, 0, 1), at(1, 0, 0), at(0, 0, 0)), grey);
    glb.addMesh("ceiling", quad(at(0, 1, 0), at(1, 1, 0), at(1, 1, 1), at(0, 1, 1)), grey);
    glb.addMesh("back wall", quad(at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0)), grey);
    glb.addMesh("left wall", quad(at(0, 0, 1), at(0, 0, 0), at(0, 1, 0), at(0, 1, 1)), red);
    glb.addMesh("right wall", quad(at(1, 0, 0), at(1, 0, 1), at(1, 1, 1), at(1, 1, 0)), green);
}

}  // namespace caustream::scenes
