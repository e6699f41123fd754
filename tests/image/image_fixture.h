// What whole-pipeline tests share: one software renderer a process, small requests, scenes put together in code.
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "render/pipeline.h"
#include "tests/gpu/synthetic_scene.h"

namespace caustream::image {

class ImageTest : public testing::Test {
   protected:
    ~ImageTest() override;   // no GL messages

    static render::Pipeline& pipeline();
    // Another one in the same context.
    static std::unique_ptr<render::Pipeline> freshPipeline();
};

// The spectral map as float RGB (or bands), 128^2 texels from a photon grid of 128.
render::Request mapRequest(const scene::Scene& scene);
// 128^2, 0 EV above the reference, so that pictures of different scenes compare.
render::Request pictureRequest(const scene::Scene& scene, render::Sample sample = render::Sample::U8);

std::vector<float> floats(const render::Frame& frame);
bool allFinite(const std::vector<float>& values);

// |flux on casters - all it went to| over flux on casters; 0 when there was none.
double ledgerGap(const render::EnergyLedger& ledger);

// Mean concentration times the direct irradiance cos / r^2 of `light` on cells x cells squares of the floor y = 0,
// x and z in -half..half; green.
std::vector<double> floorLight(const render::Frame& frame, const scene::Light& light, double half, int cells);

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

}  // namespace caustream::image
