// The reference maps and the scenes made from their JSON agree with each other.
#include <gtest/gtest.h>
#include <numeric>

#include "scene/gltf_loader.h"
#include "tests/reference/reference.h"

namespace caustream::reference {
namespace {

class References : public testing::TestWithParam<std::string> {};

TEST_P(References, MapsHoldTheFluxTheirJsonSays) {
    const Reference reference = load(GetParam());
    const std::size_t cells = static_cast<std::size_t>(reference.window.cells) * reference.window.cells;
    ASSERT_EQ(reference.mono7.shape, (std::vector<std::size_t>{7, 256, 256}));
    ASSERT_EQ(reference.direct.shape, (std::vector<std::size_t>{256, 256}));
    EXPECT_EQ(reference.nm, (std::vector<double>{380, 430, 480, 530, 580, 630, 680}));
    const double cell = reference.window.width / reference.window.cells;
    for (std::size_t band = 0; band < 7; ++band) {
        const auto begin = reference.mono7.values.begin() + static_cast<std::ptrdiff_t>(band * cells);
        const double flux = std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(cells), 0.0) * cell * cell;
        EXPECT_NEAR(flux, reference.windowFlux[band], 1e-5 * reference.windowFlux[band]);
    }
}

// Only the prism disperses enough to need its continuous spectrum.
TEST(ReferenceXyz, PrismHasItsContinuousSpectrum) {
    const Reference prism = load("prism");
    ASSERT_TRUE(prism.xyz);
    EXPECT_EQ(prism.xyz->shape, (std::vector<std::size_t>{3, 256, 256}));
    EXPECT_FALSE(load("sphere").xyz);
}

TEST_P(References, SceneIsWhatTheJsonSays) {
    const Reference reference = load(GetParam());
    const std::vector<std::uint8_t> glb = makeGlb(reference);
    const auto scene = scene::loadGlb(std::as_bytes(std::span(glb)), GetParam());
    ASSERT_TRUE(scene) << scene.error().message;
    for (const std::string& warning : scene->warnings) ADD_FAILURE() << warning;

    const scene::Light& light = scene->lights.at(0);
    EXPECT_EQ(light.intensity, 1.0f);
    EXPECT_NEAR(light.outerConeDeg, reference.halfAngleDeg, 1e-5);
    EXPECT_EQ(light.innerConeDeg, light.outerConeDeg);
    const auto& object = scene->geometry->objects.at(0);
    const scene::Material& glass = scene->materials.at(object.material);
    ASSERT_TRUE(glass.caster);
    const auto& bands = reference.json.at("files").at(GetParam() + "_mono7.npy").at("per_wavelength");
    for (const auto& band : bands) {
        EXPECT_NEAR(optics::refractiveIndex(glass.dispersion, band.at("nm")), band.at("n").get<double>(), 1e-8);
        EXPECT_NEAR(glass.absorption.at(band.at("nm")), band.at("sigma").get<double>(), 1e-8);
    }
    if (GetParam() == "sphere") {
        EXPECT_EQ(object.indexCount / 3, 5120u);
    }
}

INSTANTIATE_TEST_SUITE_P(All, References, testing::Values("sphere", "prism", "gem"),
                         [](const auto& entry) { return entry.param; });

}  // namespace
}  // namespace caustream::reference
