// depth, normals and caster_mask through the whole pipeline, against planes and a sphere that a ray meets in closed form.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "render/pipeline.h"
#include "tests/gpu/camera_fixture.h"

namespace caustream::tests {
namespace {

constexpr float kFovDeg = 60.0f;
const glm::vec3 kEye(0.3f, 0.4f, 3.0f);

struct Labels {
    int bands = 0;
    std::vector<float> values;
    const float* at(int x, int y, int width) const { return &values[static_cast<std::size_t>((y * width + x) * bands)]; }
};

class SurfaceLabelsTest : public CameraPass {
   protected:
    static constexpr int kWidth = 64, kHeight = 48;

    static render::Request request(const SyntheticScene& parts, const char* pass, render::Sample sample) {
        auto made = std::make_shared<scene::Scene>();
        auto geometry = std::make_shared<scene::Geometry>(*parts.geometry());
        for (const scene::Object& object : geometry->objects) {
            geometry->bounds.add(object.bounds);
            if (parts.materials[std::size_t(object.material)].caster) geometry->casterBounds.add(object.bounds);
        }
        made->geometry = geometry;
        made->materials = parts.materials;
        made->lights = {spotAt({0, 3, 0}, {0, -1, 0}, 100.0f)};
        render::Request request;
        request.scene = made;
        request.camera = {.eye = kEye, .target = {0.3f, 0.4f, 0.0f}, .fovYDeg = kFovDeg};
        request.target = render::Target::Pass;
        request.pass = pass;
        request.sample = sample;
        request.width = kWidth, request.height = kHeight;
        return request;
    }
    Labels labels(const SyntheticScene& parts, const char* pass) {
        const render::Frame frame = pipeline_.run(request(parts, pass, render::Sample::F32));
        EXPECT_EQ(frame.width, kWidth);
        EXPECT_EQ(frame.height, kHeight);
        EXPECT_EQ(frame.sample, render::Sample::F32);
        EXPECT_EQ(frame.mapHash, 0u);
        EXPECT_EQ(frame.stats.photons, 0u) << "no light is needed";
        Labels out{frame.bands, std::vector<float>(frame.pixels.size() / sizeof(float))};
        std::memcpy(out.values.data(), frame.pixels.data(), frame.pixels.size());
        EXPECT_EQ(out.values.size(), std::size_t(kWidth * kHeight * frame.bands));
        return out;
    }
    // Direction of the ray through a pixel's middle, row 0 at the top, z = -1.
    static glm::vec3 ray(int x, int y) {
        const float tangent = std::tan(glm::radians(kFovDeg) / 2.0f), aspect = float(kWidth) / float(kHeight);
        return {tangent * aspect * (2.0f * (float(x) + 0.5f) / kWidth - 1.0f), tangent * (1.0f - 2.0f * (float(y) + 0.5f) / kHeight), -1.0f};
    }
    // Where the ray through a pixel meets the sphere of radius r about c, as the multiple of its direction; or none.
    static std::optional<float> meets(const glm::vec3& d, const glm::vec3& c, float r) {
        const glm::vec3 o = kEye - c;
        const float a = glm::dot(d, d), b = glm::dot(o, d), rest = b * b - a * (glm::dot(o, o) - r * r);
        return rest < 0.0f ? std::nullopt : std::optional((-b - std::sqrt(rest)) / a);
    }

    render::Pipeline pipeline_{*context_, shaders_};
};

TEST_F(SurfaceLabelsTest, DepthIsTheDistanceAlongTheViewAxis) {
    SyntheticScene scene;   // z = 0.5 x, up to y = 0.9
    scene.addQuad(scene.material(matte(glm::vec3(0.5f))), {-8, -8, -4}, {16, 0, 8}, {0, 8.9f, 0});
    const Labels depth = labels(scene, "depth");
    ASSERT_EQ(depth.bands, 1);
    int nothing = 0, seen = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            // kEye + t d on the plane: 3 - t = 0.5 (0.3 + t d.x). d.z is -1: t is the depth.
            const glm::vec3 d = ray(x, y);
            const float t = (kEye.z - 0.5f * kEye.x) / (1.0f + 0.5f * d.x), height = kEye.y + t * d.y;
            if (std::abs(height - 0.9f) < 1e-3f) continue;   // the edge itself
            const float value = *depth.at(x, y, kWidth);
            if (height > 0.9f) {
                EXPECT_EQ(value, INFINITY) << x << ", " << y;
                ++nothing;
            } else {
                EXPECT_NEAR(value, t, 1e-5f * t) << x << ", " << y;   // interpolation in 32 bits
                ++seen;
            }
        }
    }
    EXPECT_GT(nothing, 100);
    EXPECT_GT(seen, 1000);
}

TEST_F(SurfaceLabelsTest, NormalsOfASphereAndOfBothSidesOfAWall) {
    const glm::vec3 centre(0.2f, 0.5f, 0.0f);
    SyntheticScene scene;
    scene.addSphere(scene.material(glass()), centre, 0.7f, 96);
    // Behind it a wall that shows its back: its outside is -z.
    scene.addQuad(scene.material(matte(glm::vec3(0.5f))), {-9, -9, -2}, {0, 18, 0}, {18, 0, 0});
    const Labels normals = labels(scene, "normals");
    ASSERT_EQ(normals.bands, 3);
    int onSphere = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const glm::vec3 d = ray(x, y);
            const float* value = normals.at(x, y, kWidth);
            const glm::vec3 normal(value[0], value[1], value[2]);
            const auto inner = meets(d, centre, 0.68f), outer = meets(d, centre, 0.71f);   // its rim is left out
            if (inner) {
                const glm::vec3 expected = (kEye + *meets(d, centre, 0.7f) * d - centre) / 0.7f;
                EXPECT_GT(glm::dot(normal, expected), 0.9995f) << x << ", " << y;   // 2 degrees: a facet's width
                EXPECT_NEAR(glm::length(normal), 1.0f, 1e-5f);
                ++onSphere;
            } else if (!outer) {
                EXPECT_NEAR(glm::distance(normal, glm::vec3(0, 0, 1)), 0.0f, 1e-6f) << "the side that is seen";
            }
        }
    }
    EXPECT_GT(onSphere, 200);
}

TEST_F(SurfaceLabelsTest, TheMaskCountsCastersAndSeesTheFirstOnly) {
    SyntheticScene scene;
    const int floor = scene.material(matte(glm::vec3(0.5f))), clear = scene.material(glass());
    scene.addSphere(clear, {-0.8f, 0.4f, 0}, 0.5f);                              // 1
    scene.addQuad(floor, {-9, -9, -2}, {18, 0, 0}, {0, 18, 0});
    scene.addSphere(clear, {1.4f, 0.4f, 0}, 0.5f);                               // 2
    scene.addSphere(clear, {1.7667f, 0.4f, -1.0f}, 0.4f);                        // 3, hidden
    scene.addQuad(floor, {-9, -9, 0.8f}, {18, 0, 0}, {0, 9.3f, 0});              // covers all below y = 0.3
    const Labels mask = labels(scene, "caster_mask");
    ASSERT_EQ(mask.bands, 1);
    int counted[3] = {};
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const glm::vec3 d = ray(x, y);
            const float value = *mask.at(x, y, kWidth);
            ASSERT_TRUE(value == 0.0f || value == 1.0f || value == 2.0f) << value << " at " << x << ", " << y;
            const float covered = kEye.y + d.y * (kEye.z - 0.8f);
            if (std::abs(covered - 0.3f) < 0.02f) continue;
            const bool first = meets(d, {-0.8f, 0.4f, 0}, 0.48f).has_value(), second = meets(d, {1.4f, 0.4f, 0}, 0.48f).has_value();
            if (covered < 0.3f || first || second) {
                EXPECT_EQ(value, covered < 0.3f ? 0.0f : first ? 1.0f : 2.0f) << x << ", " << y;
            }
            ++counted[int(value)];
        }
    }
    for (const int count : counted) EXPECT_GT(count, 50);
}

// To look at: nothing is black, what is there is not; row 0 is the top here, too.
TEST_F(SurfaceLabelsTest, PicturesOfThemShowWhatIsThere) {
    SyntheticScene scene;   // below the eye's height
    scene.addQuad(scene.material(glass()), {-9, -9, 0}, {18, 0, 0}, {0, 9.4f, 0});
    for (const char* pass : {"depth", "normals", "caster_mask"}) {
        const render::Frame frame = pipeline_.run(request(scene, pass, render::Sample::U8));
        ASSERT_EQ(frame.bands, 3) << pass;
        const auto brightest = [&](int row) {
            const auto begin = frame.pixels.begin() + row * kWidth * 3;
            return *std::max_element(begin, begin + kWidth * 3);
        };
        EXPECT_EQ(brightest(0), 0) << pass;
        EXPECT_GT(brightest(kHeight - 1), 100) << pass;
    }
    // Mid grey as far away as the camera looks, by definition.
    const render::Frame frame = pipeline_.run(request(scene, "depth", render::Sample::U8));
    EXPECT_NEAR(frame.pixels[std::size_t((kHeight - 1) * kWidth * 3)], 128, 1);
}

}  // namespace
}  // namespace caustream::tests
