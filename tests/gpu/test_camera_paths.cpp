// camera_paths against closed forms and a double-precision twin: a furnace, a slab, total reflection, a mirror.
#include "render/passes/camera_paths.h"

#include <numeric>

#include "render/convex_planes.h"
#include "render/light_uniforms.h"
#include "render/passes/camera_receivers.h"
#include "tests/gpu/camera_fixture.h"

namespace caustream::tests {
namespace {

using render::CameraPaths;
using render::Lighting;
using render::PixelBox;
using render::View;

scene::Material glassOf(double index, int priority = 0) {
    scene::Material material = glass();
    material.dispersion = optics::Cauchy{index, 0.0};
    material.priority = priority;
    return material;
}

scene::Material glowing(const glm::vec3& radiance) {
    scene::Material material = matte(glm::vec3(0.0f));
    material.emissive = radiance;
    return material;
}

scene::Material mirrorOf(const glm::vec3& color) {
    scene::Material material = matte(color);
    material.mirror = true;
    material.metallic = 1.0f;
    material.roughness = 0.0f;
    return material;
}

class CameraPathsTest : public CameraPass {
   protected:
    CameraPathsTest() : oneWavelength_(optics::sampleWavelengths(1)), allWavelengths_(optics::continuousSpectrum(4)) {}

    static scene::Scene sceneOf(const SyntheticScene& parts) {
        scene::Scene scene;
        scene.geometry = parts.geometry();
        scene.materials = parts.materials;
        return scene;
    }
    // All around, as bright as `radiance`; no light.
    static Lighting surroundedBy(float radiance) {
        Lighting lighting;
        lighting.environmentRadiance = glm::vec3(radiance * render::radianceUnit(lighting));
        return lighting;
    }

    // Draws the receivers, then paints `picture` over them if given, then the casters.
    std::vector<glm::vec4> see(const SyntheticScene& parts, const View& view, const Lighting& lighting, CameraPaths::Settings settings,
                               const std::vector<glm::vec4>& picture = {}, bool dispersive = false, const gl::Texture* mean = nullptr) {
        const scene::Scene scene = sceneOf(parts);
        const render::GpuScene gpu(scene.geometry);
        const render::ExactSurfaces surfaces(scene);
        const int size = picture.empty() ? kSize : static_cast<int>(std::sqrt(double(picture.size())));
        gl::Texture frame, depth;
        render::CameraReceivers(shaders_).run({gpu, scene.materials, lighting, view, size, size, false, {}, true}, {frame, depth});
        if (!picture.empty()) fillTexture(frame, picture);
        before_ = readTexture(frame);
        const optics::WavelengthSet& set = dispersive ? allWavelengths_ : oneWavelength_;
        const render::SpectralEntries spectrum = render::spectralEntries(set);
        CameraPaths(shaders_).run({surfaces, spectrum, glm::mat3(set.xyzToRgb), scene, gpu, lighting, view, depth, mean}, settings, frame);
        return readTexture(frame);
    }

    const View ahead_ = lookingAt({0, 0, 3}, {0, 0, 0}, 40.0f);
    optics::WavelengthSet oneWavelength_, allWavelengths_;
    std::vector<glm::vec4> before_;
};

TEST(Apart, BoxesThatTouchBecomeOne) {
    EXPECT_EQ(render::apart({{0, 0, 4, 4}, {10, 0, 4, 4}}).size(), 2u);
    EXPECT_EQ(render::apart({{0, 0, 4, 4}, {3, 3, 4, 4}, {}}), (std::vector<PixelBox>{{0, 0, 7, 7}}));
    // The first two grow over the third, which touched neither.
    EXPECT_EQ(render::apart({{0, 0, 4, 4}, {5, 6, 2, 2}, {3, 3, 4, 4}}), (std::vector<PixelBox>{{0, 0, 7, 8}}));
}

TEST_F(CameraPathsTest, AWhiteFurnaceShowsNoGlass) {
    SyntheticScene box, ball, nested, mirrors;
    box.addBox(box.material(glassOf(1.8)), {-0.6f, -0.5f, -0.4f}, {0.5f, 0.6f, 0.4f});
    ball.addSphere(ball.material(glassOf(1.5)), {0, 0, 0}, 0.7f, 24);
    nested.addSphere(nested.material(glassOf(1.5, 1)), {0, 0, 0}, 0.7f, 24);
    nested.addBox(nested.material(glassOf(1.33)), {-0.3f, -0.3f, -0.3f}, {0.3f, 0.3f, 0.3f});
    nested.addBox(nested.material(glassOf(2.4, 2)), {0.2f, -0.2f, -0.9f}, {0.4f, 0.5f, 0.9f});
    mirrors.addSphere(mirrors.material(mirrorOf(glm::vec3(1.0f))), {-0.3f, 0, 0}, 0.4f, 24);
    mirrors.addBox(mirrors.material(glassOf(1.6)), {0.2f, -0.3f, -0.3f}, {0.7f, 0.3f, 0.3f});
    for (SyntheticScene* parts : {&box, &ball, &nested, &mirrors}) {
        // A wall that glows as the surroundings do, seen by the camera and not.
        parts->addQuad(parts->material(glowing(glm::vec3(render::radianceUnit({})))), {-9, -9, -2}, {18, 0, 0}, {0, 18, 0});
        for (scene::Material& material : parts->materials) {
            if (material.caster) material.dispersion = optics::Cauchy{optics::refractiveIndex(material.dispersion, 550.0), 0.02};
        }
        for (const CameraPaths::Settings& settings : std::vector<CameraPaths::Settings>{
                 {.rays = 1, .bounces = 0}, {.rays = 2, .bounces = 1, .least = 0.03f}, {.rays = 3, .bounces = 8}, {.rays = 2, .bounces = 32, .branches = 0, .rotation = 0.3f, .sample = 5}}) {
            const auto after = see(*parts, ahead_, surroundedBy(1.0f), settings, {}, true);
            float worst = 0.0f;
            for (const glm::vec4& texel : after) {
                for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(texel[c] - 1.0f));
            }
            // Half floats round to 5e-4, the colour of a polished mirror is white within 2e-3.
            EXPECT_LT(worst, 4e-3f) << "rays " << settings.rays << ", bounces " << settings.bounces;
        }
    }
}

TEST_F(CameraPathsTest, ASlabDisplacesByItsClosedForm) {
    // Orthographic sight onto a slab turned by `angle`: x moves by t sin a (1 - cos a / (n cos a')).
    const float angle = glm::radians(40.0f), thickness = 0.6f, index = 1.6f;
    SyntheticScene parts, slab;
    parts.addQuad(parts.material(matte(glm::vec3(0.8f))), {-9, -9, -2}, {18, 0, 0}, {0, 18, 0});
    const glm::vec3 u(std::cos(angle), 0, -std::sin(angle)), n(std::sin(angle), 0, std::cos(angle));
    slab.addBox(0, {-1.2f, -0.9f, -thickness / 2}, {1.2f, 0.9f, thickness / 2});
    std::vector<glm::vec3> corners;
    for (const scene::Vertex& vertex : slab.edit().vertices) {
        corners.push_back(vertex.position.x * u + glm::vec3(0, vertex.position.y, 0) + vertex.position.z * n);
    }
    parts.addFlat(parts.material(glassOf(index)), corners);

    const int size = 256;
    std::vector<glm::vec4> picture;  // white right of the middle
    for (int i = 0; i < size * size; ++i) picture.emplace_back(glm::vec3(i % size >= size / 2 ? 1.0f : 0.0f), 1.0f);
    const auto after = see(parts, parallelView({0, 0, 3}, {0, 0, 0}, 1.0f), {}, {.rays = 1, .bounces = 0}, picture);
    const auto* row = &after[std::size_t(size / 2) * size];
    int edge = size / 4;  // on the slab's front
    while (edge < size && row[edge].g < 0.5f) ++edge;
    const float inside = std::asin(std::sin(angle) / index);
    const float shift = thickness * std::sin(angle) * (1.0f - std::cos(angle) / (index * std::cos(inside)));
    EXPECT_NEAR(float(edge), size / 2.0f + shift * size / 2.0f, 1.0f);
}

// Six walls of a room, each of its own colour, and a convex glass in it: the whole tree of bounces, in double precision.
class RoomTwin {
   public:
    RoomTwin(const scene::Scene& scene, std::size_t object, double index)
        : planes_(render::findConvexShape(*scene.geometry, scene.geometry->objects[object]).planes), index_(index) {}

    static glm::dvec3 wallColour(int axis, bool high) {
        const double shade = high ? 0.9 : 0.4;
        return glm::dvec3(axis == 0 ? shade : 0.1, axis == 1 ? shade : 0.15, axis == 2 ? shade : 0.2);
    }
    static glm::dvec3 room(const glm::dvec3& from, const glm::dvec3& way) {
        double nearest = 1e300;
        glm::dvec3 color(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            const double t = ((way[axis] > 0.0 ? kHalf : -kHalf) - from[axis]) / way[axis];
            if (t < nearest) nearest = t, color = wallColour(axis, way[axis] > 0.0);
        }
        return color;
    }
    // False: the ray passes the glass.
    bool seen(const glm::dvec3& eye, const glm::dvec3& way, int bounces, glm::dvec3& color) const {
        double enters = -1e300, leaves = 1e300;
        glm::dvec3 normal(0.0);
        for (const glm::dvec4& plane : planes_) {
            const double along = glm::dot(glm::dvec3(plane), way), t = (plane.w - glm::dot(glm::dvec3(plane), eye)) / along;
            if (along < 0.0 && t > enters) enters = t, normal = glm::dvec3(plane);
            if (along > 0.0) leaves = std::min(leaves, t);
        }
        if (enters >= leaves) return false;
        glm::dvec3 at = eye + enters * way, inside;
        double R = fresnel(way, normal, 1.0 / index_, inside);
        color = R * room(at, glm::reflect(way, normal));
        double kept = 1.0 - R;
        for (int bounce = 0; bounce <= bounces; ++bounce) {
            double t = 1e300;
            for (const glm::dvec4& plane : planes_) {
                const double along = glm::dot(glm::dvec3(plane), inside), d = (plane.w - glm::dot(glm::dvec3(plane), at)) / along;
                if (along > 1e-12 && d < t) t = d, normal = glm::dvec3(plane);
            }
            at += t * inside;
            glm::dvec3 outside;
            R = fresnel(inside, -normal, index_, outside);
            const bool last = bounce == bounces;   // what is left goes out, or on as if nothing were in its way
            if (R < 1.0 || last) color += kept * (last ? 1.0 : 1.0 - R) * room(at, R < 1.0 ? outside : inside);
            kept *= R;
            inside = glm::reflect(inside, normal);
        }
        return true;
    }
    static constexpr double kHalf = 4.0;

   private:
    static double fresnel(const glm::dvec3& way, const glm::dvec3& against, double eta, glm::dvec3& refracted) {
        const double c = -glm::dot(way, against), s2 = eta * eta * (1.0 - c * c);
        if (s2 >= 1.0) return 1.0;
        const double t = std::sqrt(1.0 - s2);
        refracted = glm::normalize(eta * way + (eta * c - t) * against);
        const double s = (eta * c - t) / (eta * c + t), p = (c - eta * t) / (c + eta * t);
        return 0.5 * (s * s + p * p);
    }
    std::vector<glm::dvec4> planes_;
    double index_;
};

TEST_F(CameraPathsTest, AConvexGemIsTheTwinsWithAllItsBounces) {
    const double index = 1.9;
    SyntheticScene parts;
    // A double pyramid of five sides: total reflection nearly everywhere.
    std::vector<glm::vec3> corners;
    const glm::vec3 top(0.05f, 0.5f, 0.0f), bottom(0.0f, -0.8f, 0.1f);
    for (int i = 0; i < 5; ++i) {
        const auto rim = [](int k) { const float a = glm::radians(72.0f * float(k) + 11.0f); return glm::vec3(0.8f * std::cos(a), 0.0f, -0.8f * std::sin(a)); };
        corners.insert(corners.end(), {rim(i), rim(i + 1), top, rim(i + 1), rim(i), bottom});
    }
    parts.addFlat(parts.material(glassOf(index)), corners);
    const float unit = render::radianceUnit({}), h = float(RoomTwin::kHalf);
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool high : {false, true}) {
            glm::vec3 corner(-h), a(0.0f), b(0.0f);
            corner[axis] = high ? h : -h;
            a[(axis + 1) % 3] = b[(axis + 2) % 3] = 2.0f * h;
            parts.addQuad(parts.material(glowing(unit * glm::vec3(RoomTwin::wallColour(axis, high)))), corner, a, b);
        }
    }
    const scene::Scene scene = sceneOf(parts);
    const RoomTwin twin(scene, 0, index);
    const View view = lookingAt({0.3f, 0.4f, 3.0f}, {0, -0.1f, 0}, 35.0f);
    for (const int bounces : {2, 8}) {
        const auto after = see(parts, view, {}, {.rays = 1, .bounces = bounces, .least = 1e-6f});
        int compared = 0, apart = 0;
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                const glm::vec2 xy = (2.0f * (glm::vec2(x, y) + 0.5f) / float(kSize) - 1.0f) * view.halfExtent;
                const glm::dvec3 way = glm::normalize(glm::dvec3(glm::transpose(glm::mat3(view.worldToView)) * glm::vec3(xy, -1.0f)));
                glm::dvec3 expected;
                if (!twin.seen(view.position(), way, bounces, expected)) continue;
                ++compared;
                const glm::vec4& got = after[std::size_t(y * kSize + x)];
                apart += glm::length(glm::dvec3(got) - expected) > 0.01;
            }
        }
        // Walls meet within a pixel of the picture, where its lookup is filtered; a ray may pass an edge on the other side.
        EXPECT_GT(compared, 800);
        EXPECT_LT(apart, compared / 25) << bounces;
    }
}

TEST_F(CameraPathsTest, AMirrorShowsThePictureMirrored) {
    SyntheticScene parts;
    parts.addQuad(parts.material(matte(glm::vec3(0.8f))), {-9, -9, -2}, {18, 0, 0}, {0, 18, 0});
    parts.addQuad(parts.material(mirrorOf(glm::vec3(1.0f))), {-9, -0.4f, -1.9f}, {0, 0, 4}, {18, 0, 0});   // lies, facing up
    const int size = 128;
    std::vector<glm::vec4> picture;
    for (int i = 0; i < size * size; ++i) picture.emplace_back(glm::vec3((((i % size) / 16) ^ ((i / size) / 16)) & 1 ? 1.0f : 0.25f), 1.0f);
    const auto after = see(parts, ahead_, {}, {.rays = 1, .bounces = 4}, picture);
    int compared = 0, apart = 0;
    for (int y = 0; y < size / 3; ++y) {
        for (int x = 0; x < size; ++x) {
            const glm::vec2 xy = (2.0f * (glm::vec2(x, y) + 0.5f) / float(size) - 1.0f) * ahead_.halfExtent;
            const float t = -0.4f / xy.y;                                        // to the mirror, per unit of depth
            if (xy.y >= 0.0f || t > 4.8f || t < 1.2f) continue;
            const float rise = -xy.y * (5.0f - t) - 0.4f;                        // on the wall, 5 m from the eye
            const glm::vec2 seen = 0.5f + 0.5f * glm::vec2(xy.x * 5.0f, rise) / (5.0f * ahead_.halfExtent);
            const glm::ivec2 texel = glm::clamp(glm::ivec2(seen * float(size)), 0, size - 1);
            const glm::vec2 place = glm::fract(seen * float(size) / 16.0f);
            if (glm::any(glm::lessThan(glm::min(place, 1.0f - place), glm::vec2(0.08f)))) continue;   // filtered
            ++compared;
            apart += std::abs(after[std::size_t(y * size + x)].g - picture[std::size_t(texel.y * size + texel.x)].g) > 0.02f;
        }
    }
    EXPECT_GT(compared, 1000);
    EXPECT_LT(apart, compared / 100);
}

TEST_F(CameraPathsTest, AMirrorShowsTheFloorThatThePictureDoesNot) {
    // It stands upright before the camera, which looks along the floor: what it shows lies behind the camera's back.
    SyntheticScene parts;
    parts.addQuad(parts.material(matte({0.5f, 0.25f, 0.75f})), {-50, -1, 50}, {100, 0, 0}, {0, 0, -100});
    parts.addQuad(parts.material(mirrorOf(glm::vec3(1.0f))), {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
    scene::Light sun;
    sun.type = scene::LightType::Directional;
    sun.direction = glm::normalize(glm::vec3(0.3f, -1, 0.2f));
    sun.intensity = 2.0f;
    const Lighting lighting = litBy(sun);
    const auto after = see(parts, lookingAt({0, -0.2f, 0.5f}, {0, -0.4f, -1}, 20.0f), lighting, {.rays = 1});
    const glm::vec3 expected = glm::vec3(0.5f, 0.25f, 0.75f) * 2.0f * -sun.direction.y / (glm::pi<float>() * render::radianceUnit(lighting));
    const glm::vec4 got = after[std::size_t(kSize / 4 * kSize + kSize / 2)];
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], expected[c], 4e-3f);
}

TEST_F(CameraPathsTest, AbsorptionFollowsTheTruePath) {
    SyntheticScene parts;
    scene::Material dark = glassOf(1.0);
    dark.absorption = {.nm = {380.0, 730.0}, .perM = {2.0, 2.0}};
    parts.addBox(parts.material(dark), {-1, -1, -0.25f}, {1, 1, 0.25f});
    const auto after = see(parts, parallelView({0, 0, 3}, {0, 0, 0}, 0.8f), surroundedBy(1.0f), {.rays = 1});
    EXPECT_NEAR(after[kSize * kSize / 2 + kSize / 2].g, std::exp(-2.0f * 0.5f), 2e-3f);
}

TEST_F(CameraPathsTest, ReceiversBeforeACasterHideIt) {
    SyntheticScene parts;
    parts.addQuad(parts.material(matte(glm::vec3(0.8f))), {-1, -1, 1}, {2, 0, 0}, {0, 2, 0});
    parts.addSphere(parts.material(glassOf(1.5)), {0, 0, 0}, 0.4f);
    EXPECT_EQ(see(parts, ahead_, surroundedBy(1.0f), {}), before_);
    SyntheticScene convex;
    convex.addQuad(convex.material(matte(glm::vec3(0.8f))), {-1, -1, 1}, {2, 0, 0}, {0, 2, 0});
    convex.addBox(convex.material(glassOf(1.5)), glm::vec3(-0.3f), glm::vec3(0.3f));
    EXPECT_EQ(see(convex, ahead_, surroundedBy(1.0f), {}), before_);
}

// Through a gem the sum over rotations of the wavelengths is the same whether a pixel takes few or many at a time.
TEST_F(CameraPathsTest, FewWavelengthsAtATimeAddUpToTheSpectrum) {
    SyntheticScene parts;
    scene::Material flint = glassOf(1.6);
    flint.dispersion = optics::Cauchy{1.6, 0.02};
    parts.addBox(parts.material(flint), {-0.6f, -0.5f, -0.4f}, {0.5f, 0.6f, 0.4f});
    parts.addQuad(parts.material(matte(glm::vec3(0.8f))), {-9, -9, -2}, {18, 0, 0}, {0, 18, 0});
    std::vector<glm::vec4> picture;
    for (int i = 0; i < kSize * kSize; ++i) picture.emplace_back(glm::vec3(i % kSize < 30 ? 0.1f : 0.9f), 1.0f);
    const View view = lookingAt({1.2f, 0.9f, 2.4f}, {0, 0, 0}, 40.0f);
    const auto many = see(parts, view, {}, {.rays = 64, .bounces = 4}, picture, true);
    gl::Texture mean(kSize, kSize, GL_RGBA32F, "mean");
    std::vector<glm::vec4> sum(many.size());
    const int frames = 64;
    for (int n = 0; n < frames; ++n) {
        const float rotation = glm::fract(0.618034f * float(n));
        const auto now = see(parts, view, {}, {.rays = 2, .bounces = 4, .rotation = rotation, .sample = n + 1}, picture, true, n ? &mean : nullptr);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += now[i];
        std::vector<glm::vec4> means = sum;
        for (glm::vec4& value : means) value /= float(n + 1);
        fillTexture(mean, means);
    }
    double off = 0.0;
    for (std::size_t i = 0; i < sum.size(); ++i) off += glm::length(glm::vec3(sum[i]) / float(frames) - glm::vec3(many[i]));
    EXPECT_LT(off / double(sum.size()), 4e-3);
}

TEST_F(CameraPathsTest, TheSameFrameHasTheSameBits) {
    SyntheticScene parts;
    parts.addSphere(parts.material(glassOf(1.5)), {0, 0, 0}, 0.7f, 24);
    parts.addBox(parts.material(glassOf(1.9)), {-0.2f, -0.2f, 0.3f}, {0.2f, 0.2f, 0.9f});
    const CameraPaths::Settings settings{.rays = 2, .bounces = 8, .branches = 1, .rotation = 0.4f, .sample = 7};
    EXPECT_EQ(see(parts, ahead_, surroundedBy(0.7f), settings, {}, true), see(parts, ahead_, surroundedBy(0.7f), settings, {}, true));
}

}  // namespace
}  // namespace caustream::tests
