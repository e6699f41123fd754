// present: known values in, known code values out.
#include "render/passes/present.h"

#include "tests/gpu/camera_fixture.h"

namespace caustream::tests {
namespace {

using render::Present;

class PresentTest : public CameraPass {
   protected:
    std::vector<glm::vec4> show(const std::vector<glm::vec4>& texels, int width, int height, Present::Inputs in,
                                GLenum format = GL_RGBA8) {
        const gl::Texture image(width, height, GL_RGBA32F, "input");
        fillTexture(image, texels);
        in.image = image.get();
        const int divide = in.downsample ? 2 : 1;
        Present(shaders_).run(in, width / divide, height / divide, format, {shown_});
        return readTexture(shown_);
    }
    static float code(float value) { return std::round(value * 255.0f); }

    gl::Texture shown_;
};

TEST_F(PresentTest, EveryVariantCompiles) { Present(shaders_).warmUp(); }

TEST_F(PresentTest, EncodesSrgbExactlyBelowTheShoulder) {
    const float linear[] = {0.0f, 0.001f, 0.0031308f, 0.01f, 0.18f, 0.2159f, 0.5f, 0.7f};
    const float expected[] = {0, 3, 10, 25, 118, 128, 188, 218};  // IEC 61966-2-1, 8 bit
    std::vector<glm::vec4> in;
    for (const float value : linear) in.emplace_back(value, value, value, 1.0f);
    const auto out = show(in, 8, 1, {});
    for (std::size_t i = 0; i < in.size(); ++i) EXPECT_EQ(code(out[i].g), expected[i]) << linear[i];
}

TEST_F(PresentTest, ScaleIsLinearBeforeTheCurve) {
    const auto out = show({{0.09f, 0.09f, 0.09f, 1}}, 1, 1, {.scale = 2.0f});
    EXPECT_EQ(code(out[0].r), 118.0f);
}

TEST_F(PresentTest, GreyStaysGreyAndRisesWithoutClipping) {
    std::vector<glm::vec4> in;
    for (int i = 0; i < 64; ++i) in.emplace_back(glm::vec3(0.01f * std::pow(1.15f, float(i))), 1.0f);
    const auto out = show(in, 64, 1, {});
    for (std::size_t i = 0; i < in.size(); ++i) {
        EXPECT_EQ(out[i].r, out[i].g);
        EXPECT_EQ(out[i].b, out[i].g);
        EXPECT_GE(out[i].g, i > 0 ? out[i - 1].g : 0.0f);
    }
    EXPECT_GT(out[63].g, 0.98f);
}

TEST_F(PresentTest, NegativeChannelsMoveToGreyOfTheSameLuminance) {
    const auto out = show({{0.5f, 0.4f, -0.2f, 1}}, 1, 1, {.mode = Present::Mode::Picture});
    EXPECT_EQ(out[0].b, 0.0f);
    const auto linear = [](float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); };
    const glm::vec3 weights(0.2126f, 0.7152f, 0.0722f);
    EXPECT_NEAR(glm::dot(glm::vec3(linear(out[0].r), linear(out[0].g), 0.0f), weights),
                glm::dot(glm::vec3(0.5f, 0.4f, -0.2f), weights), 0.01f);  // 8-bit rounding
}

TEST_F(PresentTest, TurnsRowsTopToBottom) {
    const auto out = show({{0, 0, 0, 1}, {0.5f, 0.5f, 0.5f, 1}}, 1, 2, {});
    EXPECT_GT(out[0].r, out[1].r);
}

TEST_F(PresentTest, APassOfAnotherSizeIsShownWholeInTheMiddle) {
    const gl::Texture image(2, 2, GL_RGBA32F, "input");
    fillTexture(image, std::vector<glm::vec4>(4, {1, 0, -1, 1}));
    Present(shaders_).run({.image = image.get(), .mode = Present::Mode::Normals}, 8, 4, GL_RGBA8, {shown_});
    const auto out = readTexture(shown_);
    for (int x = 0; x < 8; ++x) {
        const bool inside = x >= 2 && x < 6;   // 4 x 4 pixels of 8 x 4
        EXPECT_NEAR(out[static_cast<std::size_t>(x)].r, inside ? 1.0f : 0.1f, 0.01f) << x;
    }
}

TEST_F(PresentTest, DownsampleAveragesAfterTheCurve) {
    // One pixel of four in a focus a thousand times white: a quarter of white in light, not white.
    const auto out = show({{1000, 1000, 1000, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}}, 2, 2, {.downsample = true});
    EXPECT_NEAR(code(out[0].g), 137.0f, 1.0f);  // 0.25 linear
}

TEST_F(PresentTest, LinearFloatsPassUntouched) {
    const glm::vec4 in(-0.25f, 3e-9f, 7e5f, 1.0f);
    const auto out = show({in}, 1, 1, {.mode = Present::Mode::Linear, .scale = 2.0f}, GL_RGBA32F);
    EXPECT_EQ(glm::vec3(out[0]), 2.0f * glm::vec3(in));
}

TEST_F(PresentTest, FalseColoursAreFiniteForAnything) {
    const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
    for (const auto mode : {Present::Mode::Normals, Present::Mode::Layer, Present::Mode::Map}) {
        const auto out = show({{0, 0, 0, 0}, {1, 0, 0, 0.5f}, {nan, nan, nan, nan}, {inf, -inf, 1e-30f, inf}}, 4, 1,
                              {.mode = mode}, GL_RGBA32F);
        EXPECT_TRUE(allFinite(out)) << static_cast<int>(mode);
        EXPECT_EQ(out[0].r, 0.0f);
    }
}

}  // namespace
}  // namespace caustream::tests
