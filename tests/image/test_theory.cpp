// What must hold whatever the scene: white stays white, glass that is air is not there, light adds up.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "optics/fresnel.h"
#include "tests/image/image_fixture.h"

namespace caustream::image {
namespace {

class Theory : public ImageTest {
   protected:
    static double sumOf(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

    static int largestDifference(const render::Frame& a, const render::Frame& b) {
        EXPECT_EQ(a.pixels.size(), b.pixels.size());
        int most = 0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i) most = std::max(most, std::abs(int(a.pixels[i]) - int(b.pixels[i])));
        return most;
    }
};

TEST_F(Theory, WhiteStaysWhite) {
    for (const int wavelengths : {7, 21, render::kContinuous}) {
        render::Request request = mapRequest(sphereScene(optics::Cauchy{1.5, 0.0}));
        request.transport.wavelengths = wavelengths;
        request.transport.forceDispersive = true;
        const render::Frame frame = pipeline().run(request);
        ASSERT_EQ(frame.wavelengthsNm.size(), std::size_t(wavelengths == render::kContinuous ? 4 : wavelengths));
        const std::vector<float> map = floats(frame);
        float brightest = 0.0f, worst = 0.0f;
        for (std::size_t i = 0; i < map.size(); i += 3) {
            const float limit = std::max(1.0f, map[i + 1]);
            brightest = std::max(brightest, map[i + 1]);
            worst = std::max({worst, std::abs(map[i] - map[i + 1]) / limit, std::abs(map[i + 2] - map[i + 1]) / limit});
        }
        EXPECT_LE(worst, 1e-3f) << wavelengths << " wavelengths";
        EXPECT_GT(brightest, 5.0f);
    }
}

// A narrow beam through a wedge, spread over many times its own width: each row and column of the map that the rainbow
// lights is lit without a break.
TEST_F(Theory, ARainbowHasNoGaps) {
    for (const double B : {0.02, 0.6}) {
        tests::SyntheticScene parts;
        addFloor(parts);
        const glm::vec3 a(-0.1f, 1.5f, -0.1f), b(0.1f, 1.5f, -0.1f), c(0.1f, 1.5f, 0.1f), d(-0.1f, 1.5f, 0.1f);
        const glm::vec3 e = a + glm::vec3(0, 0.02f, 0), f = b + glm::vec3(0, 0.05f, 0), g = c + glm::vec3(0, 0.05f, 0), h = d + glm::vec3(0, 0.02f, 0);
        parts.addFlat(parts.material(glassOf(optics::Cauchy{1.458, B})),
                      {a, b, c, a, c, d, e, h, g, e, g, f, a, e, f, a, f, b, b, f, g, b, g, c, c, g, h, c, h, d, d, h, e, d, e, a});
        render::Request request = mapRequest(finish(parts, spotAbove({0, 3, 0}, {0, 1.5f, 0}, 0.8f)));
        request.transport.mapSize = 512;
        const render::Frame frame = pipeline().run(request);
        EXPECT_LE(ledgerGap(frame.stats.ledger), 1e-4);
        const std::vector<float> map = floats(frame);
        const float brightest = *std::max_element(map.begin(), map.end());
        int lit = 0, unlit = 0;
        for (const bool column : {false, true}) {
            for (int line = 0; line < frame.height; ++line) {
                int first = -1, last = -1, between = 0, dark = 0;
                for (int i = 0; i < frame.width; ++i) {
                    const int texel = column ? i * frame.width + line : line * frame.width + i;
                    const float* rgb = &map[std::size_t(3 * texel)];
                    const float light = std::max({rgb[0], rgb[1], rgb[2]}) / brightest;
                    if (light > 1e-4f && first < 0) first = i;
                    if (light > 1e-4f) last = i, between += dark, dark = 0;
                    if (light < 1e-6f && first >= 0) ++dark;   // fixed point ends there
                }
                lit += last - first;
                unlit += between;
            }
        }
        EXPECT_GT(lit, 20000) << "B = " << B;
        EXPECT_EQ(unlit, 0) << "B = " << B;
    }
}

TEST_F(Theory, GlassThatIsTheOutsideIsNotThere) {
    for (const double outside : {1.0, 1.33}) {
        scene::Scene with = sphereScene(optics::Cauchy{outside, 0.0});
        with.outsideIndex = outside;
        tests::SyntheticScene parts;
        addFloor(parts);
        scene::Scene without = finish(parts, with.lights.front());
        // The bounds choose the camera's near plane and what the environment is relative to.
        const auto geometry = std::make_shared<scene::Geometry>(*without.geometry);
        geometry->bounds = with.geometry->bounds;
        geometry->casterBounds = with.geometry->casterBounds;
        without.geometry = geometry;
        EXPECT_LE(largestDifference(pipeline().run(pictureRequest(with)), pipeline().run(pictureRequest(without))), 1);
    }
}

TEST_F(Theory, GlassThatIsAlmostTheOutsideHardlyShows) {
    // Through all passes this time: the light that the sphere takes away comes back by the map.
    scene::Scene with = sphereScene(optics::Cauchy{1.0001, 0.0}), without = sphereScene(optics::Cauchy{1.0, 0.0});
    with.environmentColor = without.environmentColor = glm::vec3(0.0f);   // relative to the light where it lands
    render::Request request = pictureRequest(with);
    request.transport.mapSize = request.transport.photonGrid = 512;
    const render::Frame a = pipeline().run(request), b = pipeline().run(pictureRequest(without));
    int apart = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) apart += std::abs(int(a.pixels[i]) - int(b.pixels[i])) > 8;
    EXPECT_LT(apart, 0.02 * double(a.pixels.size()));   // the rim of the shadow, a texel of shadow and map wide
}

TEST_F(Theory, SeveralCastersAddUp) {
    const auto scene = [](bool left, bool right) {
        tests::SyntheticScene parts;
        addFloor(parts);
        if (left) parts.addSphere(parts.material(glassOf(optics::Cauchy{1.5046, 0.0042})), {-0.5f, 0.4f, 0}, 0.25f);
        if (right) parts.addSphere(parts.material(glassOf(optics::Cauchy{1.8, 0.0})), {0.5f, 0.4f, 0}, 0.25f);
        return finish(parts, spotAbove({0, 3, 0}, {0, 0, 0}, 30.0f));
    };
    const auto light = scene(true, true).lights.front();
    const auto run = [&](bool left, bool right) {
        render::Request request = mapRequest(scene(left, right));
        request.transport.mapSize = request.transport.photonGrid = 256;
        return pipeline().run(request);
    };
    const render::Frame both = run(true, true), left = run(true, false), right = run(false, true);
    EXPECT_LE(ledgerGap(both.stats.ledger), 1e-4);
    EXPECT_NEAR(both.stats.ledger.onCasters, left.stats.ledger.onCasters + right.stats.ledger.onCasters, 1e-4 * both.stats.ledger.onCasters);
    EXPECT_NEAR(both.stats.ledger.deposited, left.stats.ledger.deposited + right.stats.ledger.deposited, 5e-3 * both.stats.ledger.deposited);
    const auto sum = floorLight(both, light, 1.0, 12), a = floorLight(left, light, 1.0, 12), b = floorLight(right, light, 1.0, 12);
    double apart = 0.0;
    for (std::size_t i = 0; i < sum.size(); ++i) apart += std::abs(sum[i] - a[i] - b[i]);
    EXPECT_LT(apart, 0.08 * sumOf(sum));   // three maps of different fit: a focus falls on a texel of another size
}

TEST_F(Theory, DirectionalLightThroughASlab) {
    tests::SyntheticScene parts;
    addFloor(parts);
    parts.addBox(parts.material(glassOf(optics::Cauchy{1.5, 0.0})), {-0.5f, 0.4f, -0.5f}, {0.5f, 0.6f, 0.5f});
    scene::Light sun;
    sun.type = scene::LightType::Directional;
    sun.intensity = 1000.0f;
    const render::Frame frame = pipeline().run(mapRequest(finish(parts, sun)));
    EXPECT_LE(ledgerGap(frame.stats.ledger), 1e-4);
    EXPECT_NEAR(frame.stats.ledger.onCasters, 1.0, 0.02);   // m^2; its rim is a photon wide
    const double kept = 0.96 * 0.96;
    EXPECT_NEAR(frame.stats.ledger.deposited, kept * frame.stats.ledger.onCasters, 5e-3 * kept);
    const auto floor = floorLight(frame, sun, 0.4, 8);      // inside the slab's shadow
    EXPECT_NEAR(sumOf(floor) / 64.0, kept, 0.01 * kept);
    for (const double cell : floor) EXPECT_NEAR(cell, kept, 0.03 * kept);   // photons' lattice on texels of another size
}

TEST_F(Theory, PointLightMakesTheSpotsCaustic) {
    const scene::Scene spot = sphereScene(optics::Cauchy{1.5, 0.0});
    scene::Scene point = spot;
    point.lights.front().type = scene::LightType::Point;
    const render::Frame a = pipeline().run(mapRequest(spot)), b = pipeline().run(mapRequest(point));
    EXPECT_LE(ledgerGap(b.stats.ledger), 1e-4);
    EXPECT_NEAR(b.stats.ledger.onCasters / a.stats.ledger.onCasters, 1.0, 1e-3);
    EXPECT_NEAR(b.stats.ledger.deposited / a.stats.ledger.deposited, 1.0, 1e-3);
}

TEST_F(Theory, AGreyCookieTakesItsShare) {
    const scene::Scene clear = sphereScene(optics::Cauchy{1.5, 0.0});
    scene::Scene grey = clear;
    auto geometry = std::make_shared<scene::Geometry>(*clear.geometry);
    geometry->textures.push_back({1, 1, {188, 188, 188, 255}});   // 0.5029 linear
    grey.geometry = geometry;
    grey.lights.front().cookie = 0;
    const render::Frame a = pipeline().run(mapRequest(clear)), b = pipeline().run(mapRequest(grey));
    EXPECT_LE(ledgerGap(b.stats.ledger), 1e-4);
    EXPECT_NEAR(b.stats.ledger.onCasters / a.stats.ledger.onCasters, 0.5029, 1e-3);
    const auto before = floats(a), after = floats(b);
    for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_NEAR(after[i], 0.5029f * before[i], 2e-3f * std::max(1.0f, before[i])) << i;
    }
}

TEST_F(Theory, AMovingCameraLeavesTheLightAlone) {
    render::Request request = pictureRequest(sphereScene(optics::Cauchy{1.5, 0.01}));
    request.still = true;
    const render::Frame first = pipeline().run(request);
    request.camera.eye = {1, 1, 2};
    const render::Frame second = pipeline().run(request);
    for (const render::PlanEntry& entry : second.stats.plan) {
        const bool camera = entry.pass.starts_with("camera") || entry.pass == "dispersive_refraction" || entry.pass == "present";
        EXPECT_EQ(entry.run, camera) << entry.pass << ": " << entry.reason;
        EXPECT_FALSE(entry.reason.empty());
    }
    EXPECT_NE(first.mapHash, 0u);
    EXPECT_EQ(second.mapHash, first.mapHash);
    EXPECT_NE(second.pixels, first.pixels);
}

}  // namespace
}  // namespace caustream::image
