#include <gtest/gtest.h>

#include "gl/context.h"
#include "gl/debug.h"
#include "render/passes/camera_receivers.h"
#include "render/passes/dispersive_refraction.h"
#include "render/passes/present.h"

namespace caustream {
namespace {

TEST(CameraShaders, EveryVariantCompiles) {
    const auto context = gl::Context::create({"software"});
    gl::ShaderLibrary shaders;
    render::CameraReceivers(shaders).warmUp();
    render::DispersiveRefraction(shaders).warmUp();
    render::Present(shaders).warmUp();
    EXPECT_TRUE(gl::takeDebugMessages().empty());
}

}  // namespace
}  // namespace caustream
