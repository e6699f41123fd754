// receiver_depth: layer values of planes, and who is drawn.
#include "render/passes/receiver_depth.h"
#include "tests/gpu/camera_fixture.h"

namespace caustream::tests {
namespace {

using render::View;

class ReceiverDepthTest : public CameraPass {
   protected:
    std::vector<float> depth(const SyntheticScene& scene, const View& view, bool casters = false) {
        const render::GpuScene gpu(scene.geometry());
        gl::Texture texture;
        render::ReceiverDepth(shaders_).run({gpu, scene.materials, view, kSize, casters}, texture);
        std::vector<float> texels(kSize * kSize);
        glGetTextureImage(texture.get(), 0, GL_DEPTH_COMPONENT, GL_FLOAT, static_cast<GLsizei>(texels.size() * sizeof(float)),
                          texels.data());
        return texels;
    }

    static float across(const View& view, int i) { return (2.0f * (float(i % kSize) + 0.5f) / kSize - 1.0f) * view.halfExtent.x; }

    const View view_ = lookingAt({0, 0, 3}, {0, 0, 0}, 60.0f);
    static constexpr std::size_t kCentre = kSize * kSize / 2 + kSize / 2;
};

TEST_F(ReceiverDepthTest, PlaneAcrossTheViewIsNearOverZ) {
    SyntheticScene scene;
    scene.addQuad(scene.material(matte(glm::vec3(1.0f))), {-9, -9, 0}, {18, 0, 0}, {0, 18, 0});
    for (const float value : depth(scene, view_)) EXPECT_NEAR(value, view_.nearM / 3.0f, 1e-8f);
}

TEST_F(ReceiverDepthTest, TiltedPlaneIsLinearInTheImage) {
    SyntheticScene scene;   // z = 0.5 x
    scene.addQuad(scene.material(matte(glm::vec3(1.0f))), {-20, -20, -10}, {40, 0, 20}, {0, 40, 0});
    const auto perspective = depth(scene, view_);
    const View parallel = parallelView({0, 0, 3}, {0, 0, 0}, 1.0f);
    const auto straight = depth(scene, parallel);
    for (int i = 0; i < kSize * kSize; ++i) {
        const float nearOverZ = view_.nearM * (1.0f + 0.5f * across(view_, i)) / 3.0f;
        EXPECT_NEAR(perspective[std::size_t(i)], nearOverZ, 2e-8f) << i;
        const float z = 3.0f - 0.5f * across(parallel, i);
        EXPECT_NEAR(straight[std::size_t(i)], (parallel.farM - z) / (parallel.farM - parallel.nearM), 1e-6f) << i;
    }
}

TEST_F(ReceiverDepthTest, NearestReceiverWinsAndNothingIsZero) {
    SyntheticScene scene;
    scene.addQuad(scene.material(matte(glm::vec3(1.0f))), {-9, -9, 1}, {9, 0, 0}, {0, 18, 0});
    scene.addQuad(0, {-9, -9, 0}, {9, 0, 0}, {0, 18, 0});
    const auto values = depth(scene, view_);
    for (int i = 0; i < kSize * kSize; ++i) {
        EXPECT_NEAR(values[std::size_t(i)], i % kSize < kSize / 2 ? view_.nearM / 2.0f : 0.0f, 1e-8f) << i;
    }
}

TEST_F(ReceiverDepthTest, CastersOnlyForShadowsAndThinWallsNever) {
    scene::Material pane = glass();
    pane.thinWalled = true;
    SyntheticScene scene;
    scene.addQuad(scene.material(matte(glm::vec3(1.0f))), {-9, -9, 0}, {18, 0, 0}, {0, 18, 0});
    scene.addQuad(scene.material(glass()), {-9, -9, 1}, {18, 0, 0}, {0, 18, 0});
    scene.addQuad(scene.material(pane), {-9, -9, 2}, {18, 0, 0}, {0, 18, 0});
    EXPECT_NEAR(depth(scene, view_)[kCentre], view_.nearM / 3.0f, 1e-8f);
    EXPECT_NEAR(depth(scene, view_, true)[kCentre], view_.nearM / 2.0f, 1e-8f);
    scene.materials[1].dispersion = optics::ConstantIndex{1.0};   // the outside's: nothing happens to light there
    EXPECT_NEAR(depth(scene, view_, true)[kCentre], view_.nearM / 3.0f, 1e-8f);
}

TEST_F(ReceiverDepthTest, SeenFromBehindAReceiverIsThereToo) {
    SyntheticScene scene;
    scene.addQuad(scene.material(matte(glm::vec3(1.0f))), {9, -9, 0}, {-18, 0, 0}, {0, 18, 0});
    EXPECT_NEAR(depth(scene, view_)[kCentre], view_.nearM / 3.0f, 1e-8f);
}

}  // namespace
}  // namespace caustream::tests
