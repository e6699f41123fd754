// Scenes put together in code, small requests, and what one looks at in their frames.
#pragma once
#include <vector>

#include "render/frame.h"
#include "tests/gpu/synthetic_scene.h"

namespace caustream::stability {

// The parts with bounds, a camera that looks at the origin, and `light`.
scene::Scene finish(const tests::SyntheticScene& parts, const scene::Light& light);
scene::Material glassOf(const optics::Dispersion& dispersion);
scene::Material white();
// 5 m to each side, at y = 0.
void addFloor(tests::SyntheticScene& parts);
// Hard edge.
scene::Light spotAbove(const glm::vec3& position, const glm::vec3& target, float halfAngleDeg);

// A sphere of radius 0.3 m, 0.5 m above the floor, under a spot 2.5 m up that lights a little more than it.
scene::Scene sphereScene(const optics::Dispersion& dispersion);
// A prism of three sides 0.5 m wide over the same floor, lit on one face so that crown glass sends a rainbow down another.
scene::Scene prismScene(const optics::Dispersion& dispersion);

// Everything about the origin, light and camera included.
scene::Scene scaled(scene::Scene scene, float by);
scene::Scene shifted(scene::Scene scene, const glm::vec3& by);

// With its geometry changed and bounded anew.
template <class Change>
scene::Scene changed(scene::Scene scene, Change&& change);
void findBounds(scene::Geometry& geometry, const std::vector<scene::Material>& materials);

// The spectral map as float RGB (or bands), 128^2 texels from a photon grid of 128.
render::Request mapRequest(const scene::Scene& scene);
// 128^2, 0 EV above the reference, so that pictures of different scenes compare.
render::Request pictureRequest(const scene::Scene& scene, render::Sample sample = render::Sample::U8);

std::vector<float> floats(const render::Frame& frame);
bool allFinite(const std::vector<float>& values);

// |flux on casters - all it went to| over flux on casters; 0 when there was none.
double ledgerGap(const render::EnergyLedger& ledger);

template <class Change>
scene::Scene changed(scene::Scene scene, Change&& change) {
    auto geometry = std::make_shared<scene::Geometry>(*scene.geometry);
    change(*geometry);
    findBounds(*geometry, scene.materials);
    scene.geometry = geometry;
    return scene;
}

}  // namespace caustream::stability
