// The spectral map against exact irradiance: photon grid 1024, map 1024, sphere of 5,120 faces, refined transport.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <glm/matrix.hpp>

#include "gl/context.h"
#include "gl/debug.h"
#include "gl/shader_library.h"
#include "render/pipeline.h"
#include "scene/gltf_loader.h"
#include "tests/image/floor_irradiance.h"

namespace caustream {
namespace {

render::Request mapOf(const reference::Reference& reference, const std::string& name, int sphereLevels = 4) {
    const std::vector<std::uint8_t> glb = reference::makeGlb(reference, sphereLevels);
    auto scene = scene::loadGlb(std::as_bytes(std::span(glb)), name);
    if (!scene) throw std::runtime_error(scene.error().message);
    render::Request request;
    request.scene = std::make_shared<const scene::Scene>(std::move(*scene));
    request.camera = request.scene->cameras.front();
    request.transport.photonGrid = 1024;
    request.transport.mapSize = 1024;
    request.target = render::Target::Spectral;
    request.sample = render::Sample::F32;
    return request;
}

render::Frame run(const render::Request& request) {
    static const auto context = gl::Context::create({.gpu = "software"});
    static gl::ShaderLibrary shaders;
    static render::Pipeline pipeline(*context, shaders);
    render::Frame frame = pipeline.run(request);
    EXPECT_THAT(gl::takeDebugMessages(), testing::IsEmpty());
    return frame;
}

image::Comparison compareScene(const std::string& name, render::Mode mode = render::Mode::Refined, int sphereLevels = 4) {
    const reference::Reference reference = reference::load(name);
    render::Request request = mapOf(reference, name, sphereLevels);
    request.transport.mode = mode;
    request.transport.wavelengthsNm = reference.nm;
    request.wavelengthBands = true;
    const render::Frame frame = run(request);
    EXPECT_EQ(frame.wavelengthsNm, reference.nm);

    std::vector<float> irradiance = image::floorIrradiance(frame, reference, 8);
    if (mode == render::Mode::Traced) {   // whose outer map is no afterthought: what bounces about lands there
        request.outerMap = true;
        const std::vector<float> outer = image::floorIrradiance(run(request), reference, 8);
        std::transform(outer.begin(), outer.end(), irradiance.begin(), irradiance.begin(), std::plus<>());
    }
    const image::Comparison result = image::compare(irradiance, reference);
    std::printf("%s%s: relative L1 %.4f, flux ratio %.4f (worst wavelength %.4f), worst centroid %.3f cells\n",
                mode == render::Mode::Thesis ? "as published, " : mode == render::Mode::Traced ? "traced, " : "", name.c_str(),
                result.relativeL1, result.fluxRatio, result.worstFluxRatio, result.worstCentroidCells);
    return result;
}

// What remains is the map's resolution in the focus: 58% of the flux falls in 100 of 65,536 cells, so that where texels
// happen to lie there moves the figure by .005 (.041 to .050 for views a few per cent apart, at any number of faces).
TEST(Reference, Sphere) {
    for (const int levels : {4, 5}) {   // 5,120 and 20,480 faces
        const image::Comparison result = compareScene("sphere", render::Mode::Refined, levels);
        EXPECT_LE(result.relativeL1, 0.049);
        EXPECT_NEAR(result.worstFluxRatio, 1.0, 0.006);
        EXPECT_LE(result.worstCentroidCells, 0.13);   // .244 where light at the rim is lost
    }
}

// Flat faces: the walk is exact after one step, what remains is the deposit at the beam's edges (.0065 in the prototype).
TEST(Reference, Prism) {
    const image::Comparison result = compareScene("prism");
    EXPECT_LE(result.relativeL1, 0.015);
    EXPECT_NEAR(result.worstFluxRatio, 1.0, 0.01);
    EXPECT_LE(result.worstCentroidCells, 1.0);
}

// Luminance against the whole spectrum, in the same fit of the colour matching functions on both sides. Seven exact
// wavelengths are .13 away.
TEST(Reference, PrismInAContinuousSpectrum) {
    const reference::Reference reference = reference::load("prism");
    ASSERT_TRUE(reference.xyz);
    render::Request request = mapOf(reference, "prism");
    request.transport.wavelengths = render::kContinuous;
    request.observer = optics::Observer::Wyman2013;
    const std::vector<float> rgb = image::floorIrradiance(run(request), reference, 8);
    const glm::dmat3 toXyz = glm::inverse(optics::xyzToRgb(request.observer));
    const std::size_t cells = rgb.size() / 3;
    double difference = 0.0, sum = 0.0, expected = 0.0;
    for (std::size_t i = 0; i < cells; ++i) {
        const double Y = (toXyz * glm::dvec3(rgb[i], rgb[cells + i], rgb[2 * cells + i])).y;
        const double known = reference.xyz->values[cells + i];
        difference += std::abs(Y - known);
        sum += Y, expected += known;
    }
    std::printf("prism, continuous: luminance's relative L1 %.4f, flux ratio %.4f\n", difference / expected, sum / expected);
    EXPECT_LE(difference / expected, 0.02);
    EXPECT_NEAR(sum / expected, 1.0, 0.01);
}

// Two interfaces cannot do better than .308 here: a faceted stone needs its internal reflections, which this transport
// does not follow. The limit holds what two interfaces give.
TEST(Reference, GemKeepsToTheTwoInterfaceFloor) {
    const image::Comparison result = compareScene("gem");
    EXPECT_LE(result.relativeL1, 0.35);
}

// Traced exactly, eight reflections inside: what remains is the map's texels and its photons.
TEST(Reference, GemTraced) {
    const image::Comparison result = compareScene("gem", render::Mode::Traced);
    EXPECT_LE(result.relativeL1, 0.03);
    EXPECT_NEAR(result.worstFluxRatio, 1.0, 0.01);
    EXPECT_LE(result.worstCentroidCells, 0.5);
}

// No worse than refined (.0454); of 20,480 faces .032.
TEST(Reference, SphereTraced) {
    const image::Comparison result = compareScene("sphere", render::Mode::Traced);
    EXPECT_LE(result.relativeL1, 0.045);
    EXPECT_NEAR(result.worstFluxRatio, 1.0, 0.01);
    EXPECT_LE(result.worstCentroidCells, 0.5);
}

TEST(Reference, PrismTraced) {
    const image::Comparison result = compareScene("prism", render::Mode::Traced);
    EXPECT_LE(result.relativeL1, 0.0071);
    EXPECT_NEAR(result.worstFluxRatio, 1.0, 0.01);
    EXPECT_LE(result.worstCentroidCells, 0.5);
}

// The published algorithm, as its printed shader does it. Its floor with infinitely many photons, computed apart, is .313
// (flux .93) and .601 (flux 1.38): a baseline that is neither crippled nor flattered lands there.
TEST(Reference, SphereAsPublished) {
    const image::Comparison result = compareScene("sphere", render::Mode::Thesis);
    EXPECT_GE(result.relativeL1, 0.29);
    EXPECT_LE(result.relativeL1, 0.34);
}

TEST(Reference, PrismAsPublished) {
    const image::Comparison result = compareScene("prism", render::Mode::Thesis);
    EXPECT_GE(result.relativeL1, 0.55);
    EXPECT_LE(result.relativeL1, 0.65);
}

}  // namespace
}  // namespace caustream
