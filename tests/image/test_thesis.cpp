// The published algorithm as a whole: what its text shows, and that it fills the same map in the same units.
#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "tests/image/image_fixture.h"

namespace caustream::image {
namespace {

class Thesis : public ImageTest {};

render::Request asPublished(const scene::Scene& scene, int wavelengths = 7) {
    render::Request request = mapRequest(scene);
    request.transport.mode = render::Mode::Thesis;
    request.transport.wavelengths = wavelengths;
    request.transport.photonGrid = request.transport.mapSize = 512;
    return request;
}

// A wedge of 4 degrees, narrow across its edge, lit from straight above: a stripe for each wavelength, side by side.
scene::Scene wedgeScene(const optics::Dispersion& glass) {
    tests::SyntheticScene parts;
    const float w = 0.002f, z = 0.15f, top = 0.6f, left = 0.58f, right = left + 2.0f * w * std::tan(glm::radians(4.0f));
    const glm::vec3 a{-w, top, -z}, b{w, top, -z}, c{w, top, z}, d{-w, top, z};
    const glm::vec3 e{-w, left, -z}, f{w, right, -z}, g{w, right, z}, h{-w, left, z};
    parts.addFlat(parts.material(glassOf(glass)), {a, d, c, a, c, b,  e, f, g, e, g, h,  a, e, h, a, h, d,
                                                   b, c, g, b, g, f,  d, h, g, d, g, c,  a, b, f, a, f, e});
    addFloor(parts);
    return finish(parts, spotAbove({0, 2.5f, 0}, {0, 0, 0}, 12.0f));
}

// Of the texels between the first and the last lit one of a row through the middle, how many are dark.
double darkShare(const render::Frame& frame) {
    const std::vector<float> map = floats(frame);
    double worst = 0.0;
    const int middle = frame.height / 2;
    // The wedge's edge runs along one axis of the map: the stripes are crossed along the other, whichever it is.
    for (const bool columns : {false, true}) {
        int first = -1, last = -1, dark = 0;
        const auto lit = [&](int i) {
            const int x = columns ? middle : i, y = columns ? i : middle;
            const float* texel = &map[static_cast<std::size_t>((y * frame.width + x) * frame.bands)];
            return std::max({texel[0], texel[1], texel[2]}) > 0.002f;
        };
        for (int i = 0; i < frame.width; ++i) {
            if (lit(i)) first = first < 0 ? i : first, last = i;
        }
        for (int i = first; i >= 0 && i <= last; ++i) dark += !lit(i);
        if (first >= 0) worst = std::max(worst, static_cast<double>(dark) / (last - first + 1));
    }
    return worst;
}

// Section 4.2: seven colours of strongly dispersing glass stand apart, and the filling closes what lies between.
TEST_F(Thesis, GapsWithoutFillingNoneWithIt) {
    const scene::Scene scene = wedgeScene(optics::Cauchy{1.458, 0.6, 0.0});
    render::Request request = asPublished(scene);
    EXPECT_GT(darkShare(pipeline().run(request)), 0.3);
    request.transport.gapFill = true;
    request.still = true;
    const render::Frame filled = pipeline().run(request);
    EXPECT_EQ(darkShare(filled), 0.0);
    const bool told = std::ranges::any_of(filled.stats.warnings, [](const std::string& w) { return w.starts_with("gap filling multiplied"); });
    EXPECT_TRUE(told) << "what it adds is no light of the lamp";
}

// The same flux on the same receiver as the refined transport, where both are right: a plate of glass under the whole
// beam, less the Fresnel reflection that the published one has none of.
TEST_F(Thesis, SharesTheMapsUnits) {
    tests::SyntheticScene parts;
    parts.addBox(parts.material(glassOf(optics::ConstantIndex{1.5})), {-0.2f, 0.5f, -0.2f}, {0.2f, 0.55f, 0.2f});
    addFloor(parts);
    const scene::Scene scene = finish(parts, spotAbove({0, 2.5f, 0}, {0, 0, 0}, 4.0f));
    const auto flux = [&](render::Mode mode) {
        render::Request request = asPublished(scene);
        request.transport.mode = mode;
        request.transport.photonGrid = 400;   // splats fall anywhere between the map's texels
        double sum = 0.0;
        for (const double cell : floorLight(pipeline().run(request), scene.lights[0], 0.5, 8)) sum += cell;
        return sum;
    };
    const double published = flux(render::Mode::Thesis), refined = flux(render::Mode::Refined);
    EXPECT_NEAR(refined / published, 0.96 * 0.96 / 0.993, 0.02);   // two faces at 4%; the splat's sum
}

TEST_F(Thesis, PlansWhatItDoes) {
    const scene::Scene scene = sphereScene(optics::Cauchy{});
    const auto names = [&](const render::Frame& frame) {
        std::vector<std::string> run;
        for (const render::PlanEntry& entry : frame.stats.plan) {
            if (entry.run) run.push_back(entry.pass);
        }
        return run;
    };
    render::Request request = asPublished(scene, render::kContinuous);
    request.target = render::Target::Composite;
    request.sample = render::Sample::U8;
    const render::Frame first = pipeline().run(request);
    EXPECT_THAT(names(first), testing::ElementsAre("receiver_depth", "caster_layers", "photon_hierarchy", "photon_splat",
                                                   "thesis_receivers", "camera_casters", "thesis_refraction", "present"));
    EXPECT_EQ(first.wavelengthsNm, (std::vector<double>{380, 430, 480, 530, 580, 630, 680}));
    EXPECT_GT(first.stats.photons, 1000u);
    EXPECT_FALSE(first.stats.error.has_value());
    EXPECT_EQ(first.stats.ledger.onCasters, 0.0) << "not counted: no ledger";

    request.camera.eye.x += 0.1f;   // a moving camera traces no photon here either
    EXPECT_THAT(names(pipeline().run(request)),
                testing::ElementsAre("thesis_receivers", "camera_casters", "thesis_refraction", "present"));
}

// Its ledger never looks like a closed one: what the glass reflects is not booked.
TEST_F(Thesis, AStillsLedgerIsOpen) {
    render::Request request = asPublished(sphereScene(optics::Cauchy{}));
    request.still = true;
    const render::Frame frame = pipeline().run(request);
    EXPECT_GT(frame.stats.ledger.onCasters, 0.0);
    EXPECT_GT(frame.stats.ledger.deposited, 0.5 * frame.stats.ledger.onCasters);
    EXPECT_GT(ledgerGap(frame.stats.ledger), 1e-3);
    EXPECT_NE(frame.mapHash, 0u);
}

TEST_F(Thesis, FiniteFromEveryWavelengthCountAndLevel) {
    for (const int wavelengths : {1, 7, 21}) {
        for (const int levels : {1, 3, 6}) {
            render::Request request = asPublished(sphereScene(optics::Cauchy{}), wavelengths);
            request.transport.photonGrid = 128;
            request.transport.hierarchyLevels = levels;
            EXPECT_TRUE(allFinite(floats(pipeline().run(request)))) << wavelengths << " " << levels;
            request.target = render::Target::Composite;
            EXPECT_TRUE(allFinite(floats(pipeline().run(request)))) << wavelengths << " " << levels;
        }
    }
}

}  // namespace
}  // namespace caustream::image
