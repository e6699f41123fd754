// The picture at rest through the whole pipeline: it adds up, it takes the place of the moving one without a jump in
// brightness and gives it back.
#include <cmath>
#include <numeric>

#include "scene/builtin_scenes.h"
#include "tests/image/image_fixture.h"

namespace caustream::image {
namespace {

class Progressive : public ImageTest {
   protected:
    // A ball of glass that fills much of the picture, so that it matters how it is traced.
    static render::Request moving(render::Sample sample = render::Sample::U8) {
        scene::Scene scene = sphereScene(optics::Cauchy{2.3, 0.015});
        scene.environmentColor = glm::vec3(0.3f);
        scene.cameras.front().eye = {0.1f, 0.7f, 0.85f};
        scene.cameras.front().target = {0, 0.5f, 0};
        render::Request request = pictureRequest(scene, sample);
        request.width = request.height = 96;
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
    const render::Request move = moving(), rest = atRest(move);
    std::vector<double> shown;
    for (int i = 0; i < 3; ++i) shown.push_back(brightness(pipeline->run(move)));
    const double before = shown.back();
    for (int i = 0; i < 60; ++i) shown.push_back(brightness(pipeline->run(rest)));
    const double resting = shown.back();
    for (int i = 0; i < 60; ++i) shown.push_back(brightness(pipeline->run(move)));
    for (std::size_t i = 1; i < shown.size(); ++i) EXPECT_NEAR(shown[i] / shown[i - 1], 1.0, 0.02) << "frame " << i;

    // Both pictures were shown as they are in the end, and they do differ.
    EXPECT_NEAR(shown.back(), before, 1e-6);
    const auto another = freshPipeline();
    render::Frame alone;
    for (int i = 0; i < 60; ++i) alone = another->run(rest);
    EXPECT_NEAR(resting / brightness(alone), 1.0, 1e-3);
    EXPECT_GT(std::abs(resting / before - 1.0), 0.03);
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

TEST_F(Progressive, FramesAddUpToTheStillPicture) {
    const auto pipeline = freshPipeline();
    render::Request rest = atRest(moving(render::Sample::F32));
    rest.camera.eye = 2.0f * rest.camera.eye;   // less glass, whose noise takes longer
    std::vector<float> mean;
    std::vector<double> off;
    render::Request still = rest;
    still.converge = false;
    still.still = true;
    const auto wanted = floats(pipeline->run(still));
    for (int i = 0; i < 48; ++i) {
        mean = floats(pipeline->run(rest));
        if (i == 0 || i == 47) off.push_back(difference(wanted, mean));
    }
    // The still has four samples a pixel of the same edges and the same light; what is left is its own noise.
    EXPECT_LT(off.back(), 0.5 * off.front());
    EXPECT_LT(off.back(), 0.04);
}

TEST_F(Progressive, AnotherViewBeginsAnew) {
    render::Request rest = atRest(moving(render::Sample::F32)), other = rest;
    other.camera.eye.x += 0.2f;
    const auto pipeline = freshPipeline(), fresh = freshPipeline();
    for (int i = 0; i < 3; ++i) pipeline->run(rest);
    fresh->run(rest);
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
    for (int i = 0; i < 8; ++i) mean = floats(pipeline->run(request));
    double darkest = 1e9, sum = 0.0;
    for (std::size_t i = 0; i + 2 < mean.size(); i += 3) {
        darkest = std::min(darkest, double(mean[i] + mean[i + 1] + mean[i + 2]));
        sum += mean[i] + mean[i + 1] + mean[i + 2];
    }
    EXPECT_GT(darkest, 0.1 * sum / double(mean.size() / 3));
}

}  // namespace
}  // namespace caustream::image
