// Glasses at the wavelengths their catalogues give: d = 587.56, F = 486.13, C = 656.27 nm.
#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include <string>

#include "optics/dispersion.h"
#include "optics/spectrum.h"

namespace caustream::optics {
namespace {

constexpr double kLineD = 587.5618, kLineF = 486.1327, kLineC = 656.2725;

double abbeNumber(const Dispersion& glass) {
    return (refractiveIndex(glass, kLineD) - 1.0) / (refractiveIndex(glass, kLineF) - refractiveIndex(glass, kLineC));
}

const Dispersion& preset(const std::string& name) {
    for (const GlassPreset& glass : kGlassPresets)
        if (glass.name == name) return glass.dispersion;
    throw std::out_of_range(name);
}

TEST(Dispersion, PresetsHaveTheirKnownIndices) {
    const struct {
        const char* name;
        double n_d, tolerance;
    } known[]{
        {"fused silica", 1.4585, 0.010},  // Malitson 1965; the thesis's two terms lie above it
        {"BK7", 1.5168, 5e-4},            // Schott
        {"K5", 1.5225, 0.013},            // Schott; above it likewise
        {"BaK4", 1.5688, 0.016},          // likewise
        {"BaF10", 1.6700, 0.022},         // likewise
        {"SF11", 1.78472, 1e-5},          // Schott
        {"diamond", 2.4176, 1e-3},        // Peter 1923 at 589.3 nm: 2.4175
        {"exaggerated", 1.4580 + 0.6 / (0.58756 * 0.58756), 1e-4},
    };
    ASSERT_EQ(std::size(known), kGlassPresets.size());
    for (const auto& glass : known)
        EXPECT_NEAR(refractiveIndex(preset(glass.name), kLineD), glass.n_d, glass.tolerance) << glass.name;
}

TEST(Dispersion, EveryPresetFallsTowardsRedAndStaysAboveOne) {
    for (const GlassPreset& glass : kGlassPresets) {
        EXPECT_TRUE(isDispersive(glass.dispersion)) << glass.name;
        for (double nm = kBandMinNm; nm < kBandMaxNm; nm += 5.0) {
            EXPECT_GT(refractiveIndex(glass.dispersion, nm), refractiveIndex(glass.dispersion, nm + 5.0)) << glass.name;
            EXPECT_GE(refractiveIndex(glass.dispersion, nm), 1.0) << glass.name;
        }
    }
}

TEST(Dispersion, CauchyIsInMicrometres) {
    EXPECT_DOUBLE_EQ(refractiveIndex(Cauchy{1.5, 0.004, 0.0002}, 500.0), 1.5 + 0.004 / 0.25 + 0.0002 / 0.0625);
}

TEST(Dispersion, AbbeGivesItsIndexAndNumberBack) {
    for (double n_d : {1.33, 1.5, 1.7847, 2.42})
        for (double V_d : {20.0, 40.0, 64.2}) {
            const Abbe glass{n_d, V_d};
            EXPECT_NEAR(refractiveIndex(glass, kLineD), n_d, 1e-4);
            EXPECT_NEAR(abbeNumber(glass), V_d, 2e-3 * V_d);  // the extension's constants have six digits
        }
    EXPECT_EQ(refractiveIndex(Abbe{1.0001, 0.001}, 680.0), 1.0);  // never below vacuum
}

TEST(Dispersion, SellmeierOfSF11HasTheCatalogueAbbeNumber) {
    EXPECT_NEAR(abbeNumber(preset("SF11")), 25.76, 0.01);
}

TEST(Dispersion, ConstantGlassDoesNotDisperse) {
    EXPECT_FALSE(isDispersive(ConstantIndex{1.5}));
    EXPECT_FALSE(isDispersive(Cauchy{1.5, 0.0, 0.0}));
    EXPECT_FALSE(isDispersive(Sellmeier{{1.2, 0.0, 0.0}, {0.0, 0.0, 0.0}}));
    EXPECT_FALSE(isDispersive(Abbe{1.5, std::numeric_limits<double>::infinity()}));
    EXPECT_DOUBLE_EQ(refractiveIndex(ConstantIndex{1.5}, 400.0), 1.5);
}

}  // namespace
}  // namespace caustream::optics
