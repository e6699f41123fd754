// caster_layers: normals and layer values against the plane they were drawn from.
#include "render/passes/caster_layers.h"
#include "tests/gpu/camera_fixture.h"

namespace caustream::tests {
namespace {

using render::CasterLayers;
using render::View;

class CasterLayersTest : public CameraPass {
   protected:
    std::vector<glm::vec4> layer(const SyntheticScene& scene, CasterLayers::Side side, const View& view,
                                 const std::function<void(const render::GpuScene&)>& occluders = {}) {
        const render::GpuScene gpu(scene.geometry());
        gl::Texture texture;
        std::function<void()> draw;
        if (occluders) draw = [&] { occluders(gpu); };
        CasterLayers(shaders_).run({gpu, gpu.geometry().objects[0], view, kSize, kSize, draw}, side, texture);
        return readTexture(texture);
    }

    // Image coordinates (tangents or metres) of a texel's middle.
    static glm::vec2 at(const View& view, int i) {
        return (2.0f * (glm::vec2(i % kSize, i / kSize) + 0.5f) / float(kSize) - 1.0f) * view.halfExtent;
    }

    static bool inside(const glm::vec2& p, float half) { return std::abs(p.x) < half && std::abs(p.y) < half; }

    const View view_ = lookingAt({0, 0, 3}, {0, 0, 0}, 60.0f);
};

TEST_F(CasterLayersTest, PlaneThatFacesTheView) {
    SyntheticScene scene;
    scene.addQuad(scene.material(glass()), {-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0});
    const auto front = layer(scene, CasterLayers::Side::Front, view_);
    const auto back = layer(scene, CasterLayers::Side::Back, view_);
    for (int i = 0; i < kSize * kSize; ++i) {
        const bool covered = inside(3.0f * at(view_, i), 0.5f);
        EXPECT_EQ(front[std::size_t(i)].w > 0.0f, covered) << i;
        EXPECT_EQ(back[std::size_t(i)], glm::vec4(0.0f)) << i;
        if (!covered) continue;
        EXPECT_NEAR(front[std::size_t(i)].w, view_.nearM / 3.0f, 1e-7f);   // one rounding of 0.0033
        EXPECT_NEAR(front[std::size_t(i)].z, 1.0f, 1e-6f);
    }
}

TEST_F(CasterLayersTest, TiltedPlaneInPerspectiveAndParallel) {
    SyntheticScene scene;   // z = 0.5 x
    scene.addQuad(scene.material(glass()), {-4, -4, -2}, {8, 0, 4}, {0, 8, 0});
    const glm::vec3 normal = glm::normalize(glm::vec3(-0.5f, 0, 1));
    View parallel = parallelView({0, 0, 3}, {0, 0, 0}, 1.0f);
    for (const View& view : {view_, parallel}) {
        const auto front = layer(scene, CasterLayers::Side::Front, view);
        for (int i = 0; i < kSize * kSize; ++i) {
            const glm::vec2 p = at(view, i);
            // Depth where the ray meets 3 - depth = 0.5 x, x = p.x depth or p.x.
            const float depth = view.perspective ? 3.0f / (1.0f + 0.5f * p.x) : 3.0f - 0.5f * p.x;
            const float expected = view.perspective ? view.nearM / depth : (view.farM - depth) / (view.farM - view.nearM);
            EXPECT_NEAR(front[std::size_t(i)].w, expected, 1e-6f) << i;
            EXPECT_LT(glm::distance(glm::vec3(front[std::size_t(i)]), normal), 1e-6f) << i;
        }
    }
}

TEST_F(CasterLayersTest, OccluderEmptiesTheTexelsBehindIt) {
    SyntheticScene scene;
    scene.addQuad(scene.material(glass()), {-4, -4, 0}, {8, 0, 0}, {0, 8, 0});
    scene.addQuad(scene.material(matte(glm::vec3(1.0f))), {0, -4, 1}, {4, 0, 0}, {0, 8, 0});
    scene.addQuad(1, {-4, -4, -1}, {4, 0, 0}, {0, 8, 0});   // behind the caster: hides nothing
    const auto front = layer(scene, CasterLayers::Side::Front, view_, [](const render::GpuScene& gpu) {
        gpu.drawWhere([](const scene::Object& object) { return object.material == 1; });
    });
    for (int i = 0; i < kSize * kSize; ++i) EXPECT_EQ(front[std::size_t(i)].w > 0.0f, i % kSize < kSize / 2) << i;
}

TEST_F(CasterLayersTest, BackLayerIsTheNearestSurfaceThatFacesAway) {
    SyntheticScene scene;   // two slabs in one object: fronts at z = 1 and -1, backs at 0 and -2
    std::vector<glm::vec3> corners;
    for (const float z : {1.0f, -1.0f}) {
        for (const glm::vec2 p : {glm::vec2(-9, -9), glm::vec2(9, -9), glm::vec2(0, 9)}) corners.emplace_back(p, z);
        for (const glm::vec2 p : {glm::vec2(-9, -9), glm::vec2(0, 9), glm::vec2(9, -9)}) corners.emplace_back(p, z - 1.0f);
    }
    scene.addFlat(scene.material(glass()), corners);
    const auto front = layer(scene, CasterLayers::Side::Front, view_);
    const auto back = layer(scene, CasterLayers::Side::Back, view_);
    const std::size_t centre = kSize * kSize / 2 + kSize / 2;
    EXPECT_NEAR(front[centre].w, view_.nearM / 2.0f, 1e-7f);
    EXPECT_NEAR(back[centre].w, view_.nearM / 3.0f, 1e-7f);
    EXPECT_NEAR(back[centre].z, -1.0f, 1e-6f);
}

TEST_F(CasterLayersTest, InterpolatedNormalsAreUnit) {
    SyntheticScene scene;
    scene.addSphere(scene.material(glass()), {0, 0, 0}, 1.0f);
    for (const auto side : {CasterLayers::Side::Front, CasterLayers::Side::Back}) {
        int covered = 0;
        for (const glm::vec4& texel : layer(scene, side, view_)) {
            if (texel.w <= 0.0f) continue;
            ++covered;
            EXPECT_NEAR(glm::length(glm::vec3(texel)), 1.0f, 1e-5f);
        }
        EXPECT_GT(covered, 500);
    }
}

TEST_F(CasterLayersTest, VerticesWithoutANormalStayFinite) {
    SyntheticScene scene;
    scene.addQuad(scene.material(glass()), {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    for (scene::Vertex& vertex : scene.edit().vertices) vertex.normal = glm::vec3(0.0f);
    EXPECT_TRUE(allFinite(layer(scene, CasterLayers::Side::Front, view_)));
}

}  // namespace
}  // namespace caustream::tests
