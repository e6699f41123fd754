// camera_casters and dispersive_refraction against closed forms: a slab's displacement, an index that is none, a furnace.
#include "render/passes/dispersive_refraction.h"

#include <numeric>

#include "render/passes/camera_receivers.h"
#include "tests/gpu/camera_fixture.h"

namespace caustream::tests {
namespace {

using render::CameraCasters;
using render::DispersiveRefraction;
using render::Lighting;
using render::PixelBox;
using render::View;
using Glass = DispersiveRefraction::Glass;

Glass oneIndex(float index) { return {.wavelengths = {{.index = index}}}; }

// `count` wavelengths from `low` to `high`, coloured as a spectrum is: negative lobes and a sum of white.
Glass dispersive(int count, float low, float high) {
    Glass glass;
    glm::vec3 sum(0.0f);
    for (int i = 0; i < count; ++i) {
        const float x = (float(i) + 0.5f) / float(count);
        const glm::vec3 rgb(1.5f - 2.0f * x, 1.2f - 4.0f * std::abs(x - 0.5f), 2.0f * x - 0.5f);
        glass.wavelengths.push_back({.index = glm::mix(high, low, x), .rgb = rgb});
        sum += rgb;
    }
    for (auto& wavelength : glass.wavelengths) wavelength.rgb /= sum;
    return glass;
}

class DispersiveRefractionTest : public CameraPass {
   protected:
    // Draws the receivers, then paints `picture` over them if given, then the casters in order. The frame afterwards.
    std::vector<glm::vec4> see(const SyntheticScene& scene, const View& view, const std::vector<Glass>& glasses,
                               const std::vector<glm::vec4>& picture = {}, const Lighting& lighting = {},
                               DispersiveRefraction::Settings settings = {}) {
        const render::GpuScene gpu(scene.geometry());
        const int size = picture.empty() ? kSize : static_cast<int>(std::sqrt(double(picture.size())));
        gl::Texture frame, depth, front, back;
        render::CameraReceivers(shaders_).run({gpu, scene.materials, lighting, view, size, size}, {frame, depth});
        if (!picture.empty()) fillTexture(frame, picture);
        before_ = readTexture(frame);

        CameraCasters casters(shaders_);
        DispersiveRefraction refraction(shaders_);
        refraction.begin(frame);
        std::size_t next = 0;
        for (const scene::Object& object : gpu.geometry().objects) {
            if (!scene.materials[std::size_t(object.material)].caster) continue;
            const PixelBox box = casters.run({gpu, object, view, size, size}, {front, back});
            if (!box.empty()) {
                refraction.run({view, front, back, box, object.bounds, depth, glasses[next], lighting}, settings, frame);
            }
            ++next;
        }
        return readTexture(frame);
    }

    // A wall at z = -2 that fills the view, and room for a caster before it.
    static SyntheticScene wall() {
        SyntheticScene scene;
        scene.addQuad(scene.material(matte(glm::vec3(0.8f))), {-9, -9, -2}, {18, 0, 0}, {0, 18, 0});
        return scene;
    }
    static std::vector<glm::vec4> checkers(int size) {
        std::vector<glm::vec4> picture;
        for (int i = 0; i < size * size; ++i) {
            const bool light = ((i % size / 8) ^ (i / size / 8)) & 1;
            picture.emplace_back(glm::vec3(light ? 1.0f : 0.25f), 1.0f);
        }
        return picture;
    }

    const View ahead_ = lookingAt({0, 0, 3}, {0, 0, 0}, 40.0f);
    std::vector<glm::vec4> before_;
};

TEST_F(DispersiveRefractionTest, EveryVariantCompiles) { DispersiveRefraction(shaders_).warmUp(); }

TEST_F(DispersiveRefractionTest, TheBoxHoldsEveryPixelOfTheCaster) {
    SyntheticScene scene;
    scene.addSphere(scene.material(glass()), {0.3f, -0.2f, 0}, 0.5f);
    const render::GpuScene gpu(scene.geometry());
    gl::Texture front, back;
    CameraCasters casters(shaders_);
    const PixelBox box =
        casters.run({gpu, gpu.geometry().objects[0], ahead_, kSize, kSize, true}, {front, back});
    ASSERT_FALSE(box.empty());
    const auto layer = readTexture(front);
    int covered = 0;
    for (int i = 0; i < kSize * kSize; ++i) {
        if (layer[std::size_t(i)].w == 0.0f) continue;
        ++covered;
        EXPECT_TRUE(i % kSize > box.x && i % kSize < box.x + box.width - 1 && i / kSize > box.y &&
                    i / kSize < box.y + box.height - 1);
    }
    EXPECT_GT(covered, box.width * box.height / 3);  // the box is of the bounds, a sphere fills half
}

TEST_F(DispersiveRefractionTest, TheBoxIsEmptyOutOfViewAndEverythingAroundTheEye) {
    const scene::Bounds behind{glm::vec3(-1, -1, 4), glm::vec3(1, 1, 5)}, beside{glm::vec3(5, 0, 0), glm::vec3(6, 1, 1)},
        around{glm::vec3(-1, -1, 2), glm::vec3(1, 1, 4)};
    EXPECT_TRUE(render::projectedBox(behind, ahead_, kSize, kSize).empty());
    EXPECT_TRUE(render::projectedBox(beside, ahead_, kSize, kSize).empty());
    EXPECT_TRUE(render::projectedBox({}, ahead_, kSize, kSize).empty());
    EXPECT_EQ(render::projectedBox(around, ahead_, kSize, kSize), (PixelBox{0, 0, kSize, kSize}));
}

TEST_F(DispersiveRefractionTest, TheOutsidesIndexLeavesThePicture) {
    SyntheticScene scene = wall();
    scene.addSphere(scene.material(glass()), {0.2f, 0.1f, 0}, 0.7f);
    const auto after = see(scene, ahead_, {oneIndex(1.0f)}, checkers(kSize));
    for (std::size_t i = 0; i < after.size(); ++i) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[i][c], before_[i][c], 2e-3f) << i;  // two half-float roundings
    }
}

TEST_F(DispersiveRefractionTest, ASlabDisplacesByItsClosedForm) {
    // Orthographic sight onto a slab turned by `angle`: x moves by t sin a (1 - cos a / (n cos a')).
    const float angle = glm::radians(40.0f), thickness = 0.6f, index = 1.6f;
    SyntheticScene scene = wall();
    const glm::vec3 u(std::cos(angle), 0, -std::sin(angle)), n(std::sin(angle), 0, std::cos(angle));
    SyntheticScene slab;
    slab.addBox(0, {-1.2f, -0.9f, -thickness / 2}, {1.2f, 0.9f, thickness / 2});
    std::vector<glm::vec3> corners;
    for (const scene::Vertex& vertex : slab.edit().vertices) {
        corners.push_back(vertex.position.x * u + glm::vec3(0, vertex.position.y, 0) + vertex.position.z * n);
    }
    scene.addFlat(scene.material(glass()), corners);

    const int size = 256;
    std::vector<glm::vec4> picture;  // white right of the middle
    for (int i = 0; i < size * size; ++i) picture.emplace_back(glm::vec3(i % size >= size / 2 ? 1.0f : 0.0f), 1.0f);
    const View view = parallelView({0, 0, 3}, {0, 0, 0}, 1.0f);
    const auto after = see(scene, view, {oneIndex(index)}, picture);
    const auto* row = &after[std::size_t(size / 2) * size];
    int edge = size / 4;  // on the slab's front
    while (edge < size && row[edge].g < 0.5f) ++edge;

    const float inside = std::asin(std::sin(angle) / index);
    const float shift = thickness * std::sin(angle) * (1.0f - std::cos(angle) / (index * std::cos(inside)));
    // The slab's front leans towards +x, so sight goes out at smaller x and the edge shows at larger.
    EXPECT_NEAR(float(edge), size / 2.0f + shift * size / 2.0f, 1.0f);
}

TEST_F(DispersiveRefractionTest, AWhiteFurnaceShowsNoGlass) {
    const std::vector<glm::vec4> white(kSize * kSize, glm::vec4(1.0f));
    for (const int bounces : {0, 2, 7, 8}) {
        for (const Glass& glassy : {oneIndex(1.5f), dispersive(7, 1.4f, 1.7f), dispersive(21, 2.2f, 2.6f)}) {
            SyntheticScene scene = wall();
            scene.addSphere(scene.material(glass()), {0, 0, 0}, 0.7f);
            const auto after = see(scene, ahead_, {glassy}, white, {}, {.bounces = bounces, .split = bounces == 7});
            // Weights sum to 1 whatever is absorbed, reflected or trapped; the rest is half-float rounding.
            for (const glm::vec4& texel : after) {
                EXPECT_NEAR(texel.g, 1.0f, 4e-3f);
                EXPECT_NEAR(texel.r, texel.g, 4e-3f);
                EXPECT_NEAR(texel.b, texel.g, 4e-3f);
            }
        }
    }
}

TEST_F(DispersiveRefractionTest, ABallTurnsTheSceneUpsideDown) {
    SyntheticScene scene = wall();
    scene.addSphere(scene.material(glass()), {0, 0, 0}, 0.7f);
    std::vector<glm::vec4> picture;  // bright above
    for (int i = 0; i < kSize * kSize; ++i) picture.emplace_back(glm::vec3(i / kSize >= kSize / 2 ? 1.0f : 0.1f), 1.0f);
    const auto after = see(scene, ahead_, {oneIndex(1.5f)}, picture);
    const auto at = [&](int x, int y) { return after[std::size_t(y * kSize + x)].g; };
    EXPECT_LT(at(32, 40), 0.4f);
    EXPECT_GT(at(32, 24), 0.7f);
}

TEST_F(DispersiveRefractionTest, AbsorptionFollowsTheTruePath) {
    SyntheticScene scene = wall();
    scene.addBox(scene.material(glass()), {-1, -1, -0.25f}, {1, 1, 0.25f});
    Glass dark = oneIndex(1.0f);
    dark.wavelengths[0].absorptionPerM = 2.0f;
    const std::vector<glm::vec4> white(kSize * kSize, glm::vec4(1.0f));
    const auto after = see(scene, parallelView({0, 0, 3}, {0, 0, 0}, 0.8f), {dark}, white);
    EXPECT_NEAR(after[kSize * kSize / 2 + kSize / 2].g, std::exp(-2.0f * 0.5f), 2e-3f);
}

TEST_F(DispersiveRefractionTest, ReceiversBeforeACasterHideIt) {
    SyntheticScene scene = wall();
    scene.addQuad(0, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0});
    scene.addSphere(scene.material(glass()), {0, 0, 0}, 0.4f);
    const auto after = see(scene, ahead_, {dispersive(7, 1.4f, 1.6f)}, checkers(kSize));
    EXPECT_EQ(after, before_);
}

TEST_F(DispersiveRefractionTest, ThinWallsTintInTurn) {
    SyntheticScene scene = wall();
    const int thin = scene.material(glass());
    scene.addBox(thin, {-1, -1, -1}, {1, 1, -0.99f});
    scene.addBox(thin, {-1, -1, 0}, {1, 1, 0.01f});
    const Glass red{.thinWalled = true, .tint = {1, 0.5f, 0.5f}}, blue{.thinWalled = true, .tint = {0.5f, 0.5f, 1}};
    const std::vector<glm::vec4> white(kSize * kSize, glm::vec4(1.0f));
    const auto after = see(scene, parallelView({0, 0, 3}, {0, 0, 0}, 0.8f), {red, blue}, white);
    const glm::vec4 centre = after[kSize * kSize / 2 + kSize / 2];
    // A plate of index 1.5 reflects 7.7% head on, of white here.
    const float R = 0.0769f, once = (1 - R) * 0.5f + R;
    EXPECT_NEAR(centre.r, (1 - R) * 0.5f + R, 0.01f);
    EXPECT_NEAR(centre.g, (1 - R) * 0.5f * once + R, 0.01f);
}

TEST_F(DispersiveRefractionTest, ExtremesStayFinite) {
    scene::Light light = spotAt({0, 0, 0}, {0, -1, 0}, 1e20f);  // inside the caster
    Lighting lighting = litBy(light);
    lighting.referenceIrradiance = 1.0f;
    for (const float index : {0.3f, 0.99f, 1.0003f, 4.0f, 5.6f}) {
        SyntheticScene scene = wall();
        scene.addSphere(scene.material(glass()), {0, 0, 0}, 0.7f, 6);
        scene.addFlat(1, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});                     // no area
        scene.addFlat(1, {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}});                  // no back
        scene.addSphere(1, {0, 0, 3}, 0.5f);                                     // the eye within
        for (scene::Vertex& vertex : scene.edit().vertices) {
            if (vertex.position.y > 0.5f) vertex.normal = glm::vec3(0.0f);
        }
        const Glass wild = dispersive(64, index, index * 1.5f);
        const auto after = see(scene, ahead_, {wild, wild, wild, wild}, {}, lighting, {16, 32, 16});
        EXPECT_TRUE(allFinite(after)) << index;
        EXPECT_TRUE(allFinite(see(scene, ahead_, {wild, wild, wild, wild}, {}, lighting, {16, 32, 16, true}))) << index;
    }
}

}  // namespace
}  // namespace caustream::tests
