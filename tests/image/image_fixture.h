// What whole-pipeline tests share: one software renderer a process, small requests and scenes put together in code (bench/stability).
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "bench/stability/scene_parts.h"
#include "render/pipeline.h"

namespace caustream::image {

class ImageTest : public testing::Test {
   protected:
    ~ImageTest() override;   // no GL messages

    static render::Pipeline& pipeline();
    // Another one in the same context.
    static std::unique_ptr<render::Pipeline> freshPipeline();
};

using stability::addFloor;
using stability::allFinite;
using stability::finish;
using stability::floats;
using stability::glassOf;
using stability::ledgerGap;
using stability::mapRequest;
using stability::pictureRequest;
using stability::sphereScene;
using stability::spotAbove;
using stability::white;

// Mean concentration times the direct irradiance cos / r^2 of `light` on cells x cells squares of the floor y = 0,
// x and z in -half..half; green.
std::vector<double> floorLight(const render::Frame& frame, const scene::Light& light, double half, int cells);

}  // namespace caustream::image
