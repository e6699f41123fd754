#include "tests/image/image_fixture.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "gl/context.h"
#include "gl/debug.h"
#include "gl/shader_library.h"

namespace caustream::image {

namespace {

struct Renderer {
    std::unique_ptr<gl::Context> context = gl::Context::create({.gpu = "software"});
    gl::ShaderLibrary shaders;
    render::Pipeline pipeline{*context, shaders};
};

Renderer& renderer() {
    static Renderer renderer;
    return renderer;
}

}  // namespace

ImageTest::~ImageTest() { EXPECT_THAT(gl::takeDebugMessages(), testing::IsEmpty()); }

render::Pipeline& ImageTest::pipeline() { return renderer().pipeline; }

std::unique_ptr<render::Pipeline> ImageTest::freshPipeline() {
    return std::make_unique<render::Pipeline>(*renderer().context, renderer().shaders);
}

std::vector<double> floorLight(const render::Frame& frame, const scene::Light& light, double half, int cells) {
    constexpr int kSamples = 48;   // several in a texel, or a focus is missed
    const std::vector<float> map = floats(frame);
    const glm::dmat4 toMap(frame.lightMatrix);
    std::vector<double> sums(static_cast<std::size_t>(cells * cells));
    for (int j = 0; j < cells * kSamples; ++j) {
        for (int i = 0; i < cells * kSamples; ++i) {
            const glm::dvec3 at(half * ((2.0 * i + 1.0) / (cells * kSamples) - 1.0), 0.0, half * ((2.0 * j + 1.0) / (cells * kSamples) - 1.0));
            const glm::dvec4 clip = toMap * glm::dvec4(at, 1.0);
            const int column = static_cast<int>(std::floor((0.5 + 0.5 * clip.x / clip.w) * frame.width));
            const int row = static_cast<int>(std::floor((0.5 + 0.5 * clip.y / clip.w) * frame.height));
            if (clip.w <= 0.0 || column < 0 || row < 0 || column >= frame.width || row >= frame.height) continue;
            const glm::dvec3 to = glm::dvec3(light.position) - at;
            const double r = glm::length(to);
            const double direct = light.type == scene::LightType::Directional ? 1.0 : to.y / (r * r * r);
            sums[static_cast<std::size_t>((j / kSamples) * cells + i / kSamples)] +=
                map[static_cast<std::size_t>((row * frame.width + column) * frame.bands + 1)] * direct / (kSamples * kSamples);
        }
    }
    return sums;
}

}  // namespace caustream::image
