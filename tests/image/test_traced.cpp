// Traced transport as a viewer at rest has it: photons add up, the estimate falls, and what Mode::Auto stands for.
#include "scene/builtin_scenes.h"
#include "tests/image/image_fixture.h"

namespace caustream::image {
namespace {

class TracedTest : public ImageTest {};

render::Request requestOf(const char* name) {
    render::Request request;
    request.scene = std::make_shared<const scene::Scene>(scene::loadBuiltin(name).value());
    request.camera = request.scene->cameras.front();
    request.width = request.height = 64;
    request.transport.mode = render::Mode::Auto;
    request.transport.mapSize = 128;
    request.transport.photonGrid = 64;
    request.transport.targetError = 0.03;
    return request;
}

bool runs(const render::Frame& frame, const std::string& pass) {
    return std::any_of(frame.stats.plan.begin(), frame.stats.plan.end(), [&](const render::PlanEntry& row) { return row.pass == pass && row.run; });
}

TEST_F(TracedTest, FramesAtRestAddPhotonsUntilTheErrorIsWhatWasAskedFor) {
    const auto pipeline = freshPipeline();
    render::Request request = requestOf("gem");
    render::Frame frame = pipeline->run(request);
    ASSERT_TRUE(frame.stats.convergence);
    const render::Convergence first = *frame.stats.convergence;
    EXPECT_FALSE(first.converged);
    request.converge = true;
    int frames = 0;
    std::uint64_t photons = first.photons;
    while (!frame.stats.convergence->converged && frames < 1000) {
        frame = pipeline->run(request);
        ++frames;
        EXPECT_GE(frame.stats.convergence->photons, photons);   // the map may be done before its picture
        EXPECT_LE(ledgerGap(frame.stats.ledger), 1e-4);
        photons = frame.stats.convergence->photons;
    }
    EXPECT_TRUE(frame.stats.convergence->converged);
    EXPECT_GT(photons, first.photons);
    EXPECT_LE(frame.stats.convergence->error, 0.03);
    EXPECT_LT(frame.stats.convergence->error, first.error);
    // What has converged is left alone.
    EXPECT_EQ(pipeline->run(request).stats.convergence->photons, photons);
}

// More threads than one dispatch may have: the same light reaches the gem, however many photons and wavelengths it is in.
TEST_F(TracedTest, NoLightIsLostToTheLimitsOfADispatch) {
    render::Request request = requestOf("gem");
    request.target = render::Target::Spectral;
    request.sample = render::Sample::F32;
    request.transport.bounces = 0;
    request.transport.wavelengths = 4;
    const double few = freshPipeline()->run(request).stats.ledger.onCasters;
    request.transport.wavelengths = 16;
    request.transport.photonGrid = 512;
    EXPECT_NEAR(freshPipeline()->run(request).stats.ledger.onCasters / few, 1.0, 1e-2);
}

TEST_F(TracedTest, AutoTracesPlanesAlwaysAndMeshesAtRest) {
    const auto pipeline = freshPipeline();
    EXPECT_TRUE(runs(pipeline->run(requestOf("prism")), "photon_paths"));
    render::Request sphere = requestOf("sphere");
    const render::Frame moving = pipeline->run(sphere);
    EXPECT_TRUE(runs(moving, "photon_trace"));
    ASSERT_TRUE(moving.stats.convergence);
    EXPECT_FALSE(moving.stats.convergence->converged);
    sphere.converge = true;
    EXPECT_TRUE(runs(pipeline->run(sphere), "photon_paths"));
    // The camera alone moves: the light that was traced stays.
    sphere.converge = false;
    sphere.camera.eye.x += 0.1f;
    const render::Frame turned = pipeline->run(sphere);
    EXPECT_FALSE(runs(turned, "photon_trace"));
    EXPECT_GT(turned.stats.convergence->photons, 0u);
    sphere.scene = [&] {
        auto moved = std::make_shared<scene::Scene>(*sphere.scene);
        moved->lights.front().position.x += 0.05f;
        return moved;
    }();
    EXPECT_TRUE(runs(pipeline->run(sphere), "photon_trace"));
}

TEST_F(TracedTest, EqualInputGivesEqualBits) {
    render::Request request = requestOf("gem");
    request.still = true;
    const std::uint64_t once = freshPipeline()->run(request).mapHash, again = freshPipeline()->run(request).mapHash;
    EXPECT_NE(once, 0u);
    EXPECT_EQ(once, again);
}

}  // namespace
}  // namespace caustream::image
