// The picture at rest through the whole pipeline: it adds up, it takes the place of the moving one without a jump in
// brightness and gives it back.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/builtin_scenes.h"
#include "tests/image/image_fixture.h"

namespace caustream::image {
namespace {

class Progressive : public ImageTest {
   protected:
    // A ball of glass before a mirror, which is one in traced pictures only: it matters how it is drawn. `lit`: by a lamp
    // whose photons are as many as there is time for, else by one that misses both.
    static render::Request moving(render::Sample sample = render::Sample::U8, bool lit = false) {
        tests::SyntheticScene parts;
        parts.addSphere(parts.material(glassOf(optics::Cauchy{1.7, 0.015})), {0, 0.5f, 0}, 0.3f, 24);
        scene::Material silver;
        silver.mirror = true;
        silver.metallic = 1.0f;
        silver.roughness = 0.0f;
        parts.addQuad(parts.material(silver), {-1, 0.1f, -0.5f}, {2, 0, 0}, {0, 2, 0});
        scene::Material lamp;      // behind the camera: the mirror shows it
        lamp.emissive = glm::vec3(8.0f);
        parts.addQuad(parts.material(lamp), {2, 0, 4}, {-4, 0, 0}, {0, 3, 0});
        addFloor(parts);
        scene::Scene scene = finish(parts, spotAbove({0.5f, 2.5f, 0.3f}, lit ? glm::vec3(0, 0.5f, 0) : glm::vec3(1.5f, 0, 0.5f), 12.0f));
        scene.environmentColor = glm::vec3(0.3f);
        scene.cameras.front().eye = {0.1f, 0.9f, 1.1f};
        scene.cameras.front().target = {0, 0.5f, 0};
        render::Request request = pictureRequest(scene, sample);
        request.width = request.height = 96;
        request.exposureEv = -2.0f;   // below the tone curve's shoulder, which would hide differences
        return request;
    }
    static render::Request atRest(render::Request request) {
        request.transport.mode = render::Mode::Traced;
        request.converge = true;
        return request;
    }

    // Linear luminance as a display shows it.
    static double brightness(const render::Frame& frame) {
        double sum = 0.0;
        for (std::size_t i = 0; i + 2 < frame.pixels.size(); i += 3) {
            const auto linear = [&](std::size_t at) {
                const double x = frame.pixels[at] / 255.0;
                return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
            };
            sum += 0.2126 * linear(i) + 0.7152 * linear(i + 1) + 0.0722 * linear(i + 2);
        }
        return 3.0 * sum / static_cast<double>(frame.pixels.size());
    }

    static double difference(const std::vector<float>& a, const std::vector<float>& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
        return sum / std::accumulate(a.begin(), a.end(), 1e-9);
    }
};

TEST_F(Progressive, BrightnessNeverJumps) {
    const auto pipeline = freshPipeline();
    const render::Request move = moving(render::Sample::U8, true), rest = atRest(move);
    std::vector<double> shown;
    for (int i = 0; i < 3; ++i) shown.push_back(brightness(pipeline->run(move)));
    const double before = shown.back();
    for (int i = 0; i < 40; ++i) shown.push_back(brightness(pipeline->run(rest)));
    const double resting = shown.back();
    for (int i = 0; i < 60; ++i) shown.push_back(brightness(pipeline->run(move)));
    for (std::size_t i = 1; i < shown.size(); ++i) EXPECT_NEAR(shown[i] / shown[i - 1], 1.0, 0.02) << "frame " << i;

    // Both pictures were shown as they are in the end, and they do differ.
    EXPECT_NEAR(shown.back(), before, 1e-6);
    const auto another = freshPipeline();
    render::Frame alone;
    for (int i = 0; i < 40; ++i) alone = another->run(rest);
    EXPECT_NEAR(resting / brightness(alone), 1.0, 5e-3);
    EXPECT_GT(std::abs(resting / before - 1.0), 0.03);
}

// A slow connection's moving pictures are smaller than what is shown at rest.
TEST_F(Progressive, BrightnessDoesNotJumpWhereTheMovingPictureIsSmaller) {
    const auto pipeline = freshPipeline();
    render::Request move = moving(render::Sample::U8, true);
    const render::Request rest = atRest(move);
    move.width = move.height = 48;
    std::vector<double> shown;
    for (int i = 0; i < 2; ++i) shown.push_back(brightness(pipeline->run(move)));
    const double before = shown.back();
    for (int i = 0; i < 40; ++i) shown.push_back(brightness(pipeline->run(rest)));
    EXPECT_GT(std::abs(shown.back() / before - 1.0), 0.03);   // a jump that there could be
    for (int i = 0; i < 10; ++i) shown.push_back(brightness(pipeline->run(move)));
    for (std::size_t i = 1; i < shown.size(); ++i) EXPECT_NEAR(shown[i] / shown[i - 1], 1.0, 0.02) << "frame " << i;
}

// Neither the light's photons nor the picture's samples are lost to a smaller picture in between.
TEST_F(Progressive, ASmallerPictureLosesNothing) {
    const auto smaller = [](render::Request request) {
        request.width = request.height = 48;
        request.converge = false;
        return request;
    };
    // Photons a frame depend on the clock: of those it is counted that they grow, and of a picture without any each sample.
    const auto pipeline = freshPipeline(), undisturbed = freshPipeline();
    const render::Request dark = atRest(moving(render::Sample::F32)), lit = atRest(moving(render::Sample::F32, true));
    std::uint64_t photons = 0;
    for (int i = 0; i < 6; ++i) {
        EXPECT_EQ(pipeline->run(dark).pixels, undisturbed->run(dark).pixels) << "frame " << i;
        EXPECT_EQ(pipeline->run(smaller(dark)).width, 48);
        const render::Frame frame = pipeline->run(lit);
        EXPECT_GT(frame.stats.convergence->photons, photons);
        photons = frame.stats.convergence->photons;
        for (const render::PlanEntry& entry : pipeline->run(smaller(lit)).stats.plan) {
            if (entry.pass == "photon_paths" || entry.pass == "receiver_depth") { EXPECT_FALSE(entry.run) << entry.pass; }
        }
    }
}

TEST_F(Progressive, MotionThatResumesAmidThePassageDoesNotJumpEither) {
    const auto pipeline = freshPipeline();
    const render::Request move = moving(), rest = atRest(move);
    std::vector<double> shown;
    for (const int restFrames : {1, 2, 3, 5}) {
        for (int i = 0; i < 2; ++i) shown.push_back(brightness(pipeline->run(move)));
        for (int i = 0; i < restFrames; ++i) shown.push_back(brightness(pipeline->run(rest)));
    }
    for (std::size_t i = 1; i < shown.size(); ++i) EXPECT_NEAR(shown[i] / shown[i - 1], 1.0, 0.02) << "frame " << i;
}

TEST_F(Progressive, NumbersAreNeverEased) {
    // Floats are for measuring: each frame is its own mode's.
    const auto pipeline = freshPipeline();
    const render::Request move = moving(render::Sample::F32), rest = atRest(move);
    const auto first = floats(pipeline->run(move));
    for (int i = 0; i < 4; ++i) pipeline->run(rest);
    EXPECT_EQ(floats(pipeline->run(move)), first);
}

TEST_F(Progressive, FramesAddUp) {
    const auto pipeline = freshPipeline();
    render::Request rest = atRest(moving(render::Sample::F32));
    std::vector<std::vector<float>> means;
    for (int i = 0; i < 96; ++i) means.push_back(floats(pipeline->run(rest)));
    // Noise falls as the root of the number of samples: between 8 and 32 of 96 to 0.43. The first is white in itself, so less noisy.
    EXPECT_LT(difference(means[95], means[31]), 0.5 * difference(means[95], means[0]));
    EXPECT_LT(difference(means[95], means[31]), 0.6 * difference(means[95], means[7]));
}

TEST_F(Progressive, AnotherViewBeginsAnew) {
    render::Request rest = atRest(moving(render::Sample::F32)), other = rest;
    other.camera.eye.x += 0.2f;
    const auto pipeline = freshPipeline(), fresh = freshPipeline();
    render::Request third = rest;
    third.camera.eye.z += 0.2f;
    for (int i = 0; i < 3; ++i) pipeline->run(rest);
    fresh->run(third);
    EXPECT_EQ(floats(pipeline->run(other)), floats(fresh->run(other)));
}

TEST_F(Progressive, TheSameFramesHaveTheSameBits) {
    const auto sequence = [] {
        const auto pipeline = freshPipeline();
        const render::Request move = moving();
        std::vector<std::vector<std::uint8_t>> frames;
        for (int i = 0; i < 2; ++i) frames.push_back(pipeline->run(move).pixels);
        for (int i = 0; i < 4; ++i) frames.push_back(pipeline->run(atRest(move)).pixels);
        frames.push_back(pipeline->run(move).pixels);
        return frames;
    };
    EXPECT_EQ(sequence(), sequence());
}

TEST_F(Progressive, AGlassOfWaterHasNoBlackHoles) {
    auto scene = scene::loadBuiltin("water");
    ASSERT_TRUE(scene);
    scene->environmentColor = glm::vec3(1.0f);   // no place is darker than its surroundings' share
    render::Request request = atRest(pictureRequest(*scene, render::Sample::F32));
    request.width = request.height = 96;
    const auto pipeline = freshPipeline();
    std::vector<float> mean;
    for (int i = 0; i < 6; ++i) mean = floats(pipeline->run(request));
    double darkest = 1e9, sum = 0.0;
    for (std::size_t i = 0; i + 2 < mean.size(); i += 3) {
        darkest = std::min(darkest, double(mean[i] + mean[i + 1] + mean[i + 2]));
        sum += mean[i] + mean[i + 1] + mean[i + 2];
    }
    EXPECT_GT(darkest, 0.03 * sum / double(mean.size() / 3));
}

TEST_F(Progressive, ViewersDoNotDisturbEachOther) {
    // The frames of one that rests, moves and rests, alone and with another's in between.
    const render::Request move = moving(), rest = atRest(move);
    render::Request other = moving();
    other.viewer = 2;
    other.camera.eye = {0.4f, 0.7f, 1.3f};
    const std::vector<render::Request> played = {move, move, rest, rest, rest, move, move, rest, rest};
    const auto alone = freshPipeline(), shared = freshPipeline();
    for (std::size_t i = 0; i < played.size(); ++i) {
        const auto expected = alone->run(played[i]).pixels;
        shared->run(i % 3 == 0 ? atRest(other) : other);
        EXPECT_EQ(shared->run(played[i]).pixels, expected) << "frame " << i;
    }
}

TEST_F(Progressive, EveryViewerConvergesHoweverManyThereAre) {
    constexpr int kViewers = 7;
    const auto pipeline = freshPipeline();
    std::vector<render::Request> viewers;
    std::vector<std::uint64_t> keys;
    std::vector<const scene::Geometry*> shown;
    for (int i = 0; i < kViewers; ++i) {
        render::Request request = atRest(moving(render::Sample::U8, true));
        scene::Scene turned = *request.scene;
        turned.lights.front().position.x += 0.01f * static_cast<float>(i);
        request.scene = std::make_shared<const scene::Scene>(std::move(turned));
        request.viewer = static_cast<std::uint64_t>(i) + 1;
        request.transport.targetError = 0.2;
        viewers.push_back(request);
        keys.push_back(request.viewer);
        shown.push_back(request.scene->geometry.get());
    }
    pipeline->collect(shown, keys);
    std::vector<bool> done(kViewers);
    for (int frame = 0; frame < 120; ++frame) {
        for (int i = 0; i < kViewers; ++i) {
            const auto& reached = pipeline->run(viewers[static_cast<std::size_t>(i)]).stats.convergence;
            done[static_cast<std::size_t>(i)] = done[static_cast<std::size_t>(i)] || (reached && reached->converged);
        }
        if (std::ranges::all_of(done, [](bool one) { return one; })) {
            return;
        }
    }
    EXPECT_THAT(done, testing::Each(true)) << "each in turn, and none of them begins anew";
}

}  // namespace
}  // namespace caustream::image
