// White stays white: weights of any sampling sum to (1, 1, 1), and so does any partition of the band.
#include <gtest/gtest.h>
#include <cmath>
#include <numeric>
#include <random>

#include "optics/absorption.h"
#include "optics/cie_tables.h"
#include "optics/colour.h"

namespace caustream::optics {
namespace {

const std::vector<Spectrum> kSpectra{EqualEnergy{},     DaylightD65{},      Blackbody{1000.0},
                                     Blackbody{2856.0}, Blackbody{20000.0}, Lines{{486.1, 589.3, 656.3}},
                                     Lines{{450.0}}};

glm::dvec3 total(const WavelengthSet& set) {
    return std::accumulate(set.xyz.begin(), set.xyz.end(), glm::dvec3(0.0));
}

void expectNear(const glm::dvec3& got, const glm::dvec3& wanted, double tolerance) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], wanted[c], tolerance) << "channel " << c;
}

TEST(Colour, WeightsOfEveryCountAndSpectrumSumToWhite) {
    for (std::size_t s = 0; s < kSpectra.size(); ++s)
        for (int count = 1; count <= 64; ++count) {
            SCOPED_TRACE("spectrum " + std::to_string(s) + ", count " + std::to_string(count));
            const WavelengthSet set = sampleWavelengths(count, kSpectra[s]);
            expectNear(set.xyzToRgb * total(set), glm::dvec3(1.0), 1e-6);
            for (const glm::dvec3& xyz : set.xyz)
                for (int c = 0; c < 3; ++c) EXPECT_GE(xyz[c], 0.0);
            EXPECT_TRUE(std::is_sorted(set.nm.begin(), set.nm.end()));
            EXPECT_EQ(set.nm.size(), set.xyz.size());
        }
}

TEST(Colour, GivenWavelengthsSumToWhiteToo) {
    const std::vector<double> nm{380, 430, 480, 530, 580, 630, 680};
    for (const Spectrum& spectrum : kSpectra) {
        const WavelengthSet set = sampleWavelengthsAt(nm, spectrum);
        EXPECT_EQ(set.nm, nm);
        expectNear(set.xyzToRgb * total(set), glm::dvec3(1.0), 1e-6);
    }
}

TEST(Colour, OneWavelengthIsTheHeliumLineAndWhite) {
    const WavelengthSet set = sampleWavelengths(1);
    ASSERT_EQ(set.nm.size(), 1u);
    EXPECT_DOUBLE_EQ(set.nm[0], 587.56);
    expectNear(set.xyzToRgb * set.xyz[0], glm::dvec3(1.0), 1e-12);
}

TEST(Colour, WavelengthsAreCentresOfEqualIntervalsInInverseSquare) {
    const int count = 7;
    const WavelengthSet set = sampleWavelengths(count);
    const double violet = 1.0 / (380.0 * 380.0), red = 1.0 / (680.0 * 680.0);
    for (int i = 0; i < count; ++i)
        EXPECT_NEAR(1.0 / (set.nm[i] * set.nm[i]), violet + (red - violet) * (i + 0.5) / count, 1e-18);
}

TEST(Colour, LinesAreTracedAtTheLines) {
    const WavelengthSet set = sampleWavelengths(7, Lines{{656.3, 486.1, 656.3, 900.0}});
    EXPECT_EQ(set.nm, (std::vector<double>{486.1, 656.3}));  // ascending, once, inside the band
}

TEST(Colour, AnyPartitionOfTheBandSumsToTheBand) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> inBand(kBandMinNm, kBandMaxNm);
    for (int pieces : {2, 3, 10, 1000}) {
        std::vector<double> edges{kBandMinNm, kBandMaxNm};
        for (int i = 1; i < pieces; ++i) edges.push_back(inBand(random));
        std::sort(edges.begin(), edges.end());
        glm::dvec3 sum(0.0);
        for (std::size_t i = 1; i < edges.size(); ++i) sum += intervalXyz(edges[i - 1], edges[i]);
        expectNear(sum, intervalXyz(kBandMinNm, kBandMaxNm), 1e-12);
    }
    EXPECT_NEAR(intervalXyz(kBandMinNm, kBandMaxNm).y, 1.0, 1e-15);
    expectNear(xyzToRgb() * intervalXyz(kBandMinNm, kBandMaxNm), glm::dvec3(1.0), 1e-12);
}

TEST(Colour, TheObserverIsTheTableAtItsNodes) {
    EXPECT_DOUBLE_EQ(cieXyz(555.0).y, 1.0);
    EXPECT_DOUBLE_EQ(cieXyz(600.0).x, 1.0622);
    EXPECT_DOUBLE_EQ(cieXyz(445.0).z, 1.7826);
    EXPECT_EQ(cieXyz(379.0), glm::dvec3(0.0));
    // Wyman, Sloan & Shirley 2013, Simple Analytic Approximations to the CIE XYZ Color Matching Functions, eq. 4: an
    // independent fit of luminance, within 1.5 % of the peak everywhere.
    const auto lobe = [](double x, double mu, double below, double above) {
        const double t = (x - mu) * (x < mu ? below : above);
        return std::exp(-0.5 * t * t);
    };
    for (double nm = kBandMinNm; nm <= kBandMaxNm; nm += 1.0)
        EXPECT_NEAR(cieXyz(nm).y, 0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322),
                    0.015)
            << nm;
}

// Known chromaticities (CIE 015:2018), within what cutting the band to 380-680 nm changes.
TEST(Colour, SpectraHaveTheirChromaticities) {
    const auto chromaticity = [](const Spectrum& spectrum) {
        const glm::dvec3 sum = total(sampleWavelengths(64, spectrum));
        return glm::dvec2(sum.x, sum.y) / (sum.x + sum.y + sum.z);
    };
    EXPECT_NEAR(chromaticity(EqualEnergy{}).x, 0.3333, 3e-3);
    EXPECT_NEAR(chromaticity(DaylightD65{}).x, 0.3127, 3e-3);
    EXPECT_NEAR(chromaticity(DaylightD65{}).y, 0.3290, 3e-3);
    EXPECT_NEAR(chromaticity(Blackbody{2856.0}).x, 0.4476, 5e-3);  // illuminant A
    EXPECT_NEAR(chromaticity(Blackbody{2856.0}).y, 0.4074, 5e-3);
}

TEST(Colour, LightColourHasLuminanceOne) {
    for (const Spectrum& spectrum : kSpectra) {
        const glm::dvec3 rgb = sampleWavelengths(7, spectrum).lightRgb;
        EXPECT_NEAR(0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b, 1.0, 1e-12);
        for (int c = 0; c < 3; ++c) EXPECT_GE(rgb[c], 0.0);
    }
    expectNear(sampleWavelengths(7, EqualEnergy{}).lightRgb, glm::dvec3(1.0), 1e-12);
}

TEST(Spectrum, BlackbodyPeaksWhereWienSays) {
    // Wien 1893: peak = 2.897772e6 nm K / T; 5270 K peaks at 550 nm.
    const Blackbody light{5270.0};
    EXPECT_GT(relativePower(light, 550.0), relativePower(light, 530.0));
    EXPECT_GT(relativePower(light, 550.0), relativePower(light, 570.0));
    for (double kelvin : {1.0, 100.0, 1e9})
        for (double nm : {380.0, 530.0, 680.0}) EXPECT_TRUE(std::isfinite(relativePower(Blackbody{kelvin}, nm)));
}

TEST(Spectrum, NothingOutsideTheBand) {
    for (const Spectrum& spectrum : kSpectra) {
        EXPECT_EQ(relativePower(spectrum, 379.9), 0.0);
        EXPECT_EQ(relativePower(spectrum, 680.1), 0.0);
        EXPECT_EQ(relativePower(spectrum, std::nan("")), 0.0);
    }
    EXPECT_DOUBLE_EQ(relativePower(DaylightD65{}, 560.0), 1.0);
}

// What white light looks like after `distanceM` of the glass.
glm::dvec3 throughGlass(const Absorption& absorption, double distanceM) {
    glm::dvec3 rgb(0.0);
    for (double nm = kBandMinNm; nm < kBandMaxNm; nm += 1.0)
        rgb += xyzToRgb() * intervalXyz(nm, nm + 1.0) * std::exp(-distanceM * absorption.at(nm + 0.5));
    return rgb;
}

TEST(Absorption, GivesItsColourBack) {
    for (double distance : {0.01, 1.0, 250.0})
        for (const glm::dvec3& color :
             {glm::dvec3(0.5), glm::dvec3(0.9, 0.95, 0.91), glm::dvec3(0.2, 0.6, 0.3), glm::dvec3(0.1, 0.1, 0.8),
              glm::dvec3(0.7, 0.3, 0.05), glm::dvec3(0.02, 0.4, 0.4), glm::dvec3(1.0, 0.5, 0.5),
              glm::dvec3(0.95, 0.05, 0.05)}) {
            SCOPED_TRACE(std::to_string(color.r) + " " + std::to_string(color.g) + " " + std::to_string(color.b));
            const Absorption absorption = absorptionFromRgb(color, distance);
            // A quarter of an 8-bit step: the table's linear pieces against the sigmoid that was fitted.
            expectNear(throughGlass(absorption, distance), color, 1e-3);
            for (double sigma : absorption.perM) EXPECT_GE(sigma, 0.0);
        }
}

TEST(Absorption, ExtremeColoursStayFiniteAndNear) {
    for (double r : {0.0, 1.0})
        for (double g : {0.0, 1.0})
            for (double b : {0.0, 1.0}) {
                const Absorption absorption = absorptionFromRgb({r, g, b}, 2.0);
                for (double sigma : absorption.perM) EXPECT_TRUE(std::isfinite(sigma) && sigma >= 0.0);
                expectNear(throughGlass(absorption, 2.0), {r, g, b}, 5e-3);  // corners of the cube need a box spectrum
            }
}

TEST(Absorption, WhiteOrNoDistanceIsNone) {
    EXPECT_TRUE(absorptionFromRgb(glm::dvec3(1.0), 1.0).empty());
    EXPECT_TRUE(absorptionFromRgb(glm::dvec3(0.5), INFINITY).empty());
    EXPECT_EQ(Absorption{}.at(500.0), 0.0);
}

TEST(Absorption, IsLinearBetweenItsNodesAndConstantOutside) {
    const Absorption table{{380.0, 680.0}, {0.1, 0.3}};
    EXPECT_DOUBLE_EQ(table.at(530.0), 0.2);
    EXPECT_DOUBLE_EQ(table.at(380.0), 0.1);
    EXPECT_DOUBLE_EQ(table.at(300.0), 0.1);
    EXPECT_DOUBLE_EQ(table.at(700.0), 0.3);
}

}  // namespace
}  // namespace caustream::optics
