// What a file may leave out and a picture needs: a light, a camera, something for light to land on.
#pragma once
#include "scene/scene.h"

namespace caustream::scene {

// From above and behind, its cone a little wider than the subject.
Light placeLight(const Bounds& subject, const Bounds& everything);

// Looks down at the subject and the floor in front of it.
Camera placeCamera(const Bounds& subject);

// A square floor under the subject, wide enough for light that comes in at an angle: two triangles' vertices, facing
// up.
std::vector<Vertex> placeFloor(const Bounds& subject);

}  // namespace caustream::scene
