// A reference scene as POV-Ray reads it: the same planes or ball, index and absorption at one wavelength, light, floor, and
// an orthographic camera that looks down at the window, a pixel a cell.
#pragma once
#include <cstdint>
#include <string>

#include "scene/scene.h"
#include "tests/reference/reference.h"

namespace caustream::peers {

struct PovrayPhotons {
    std::int64_t count = 100'000;        // asked for; about a quarter of them meets the caster
    int gatherLeast = 10, gatherMost = 30;   // photons of an estimate
};

// The caustic and the direct light.
// `caster` is what it fits in: POV-Ray aims at it.
std::string povrayScene(const reference::Reference& reference, const scene::Bounds& caster, double nm, const PovrayPhotons& photons);

// The same with a black caster: the direct light alone.
std::string povrayDirectScene(const reference::Reference& reference, const scene::Bounds& caster);

}  // namespace caustream::peers
