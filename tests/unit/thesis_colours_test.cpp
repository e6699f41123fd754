// Table 2 of Blanchette 2012 and what is made of it.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render/frame.h"
#include "render/thesis_colours.h"

namespace caustream::render {
namespace {

TEST(ThesisColours, SevenAreTheTables) {
    const double table[7][4] = {{380, 77, 0, 204}, {430, 51, 51, 255},   {480, 0, 229.5, 255}, {530, 76.5, 255, 102},
                                {580, 204, 229.5, 77}, {630, 229.5, 128, 0}, {680, 255, 0, 0}};
    const optics::WavelengthSet set = thesisWavelengths(7);
    ASSERT_EQ(set.nm.size(), 7u);
    double sums[3] = {};
    for (std::size_t i = 0; i < 7; ++i) {
        EXPECT_EQ(set.nm[i], table[i][0]);
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(set.xyz[i][k] * 892.5, table[i][k + 1], 0.5) << i;   // the table rounds up, the shader does not
            sums[k] += table[i][k + 1];
        }
    }
    for (const double sum : sums) EXPECT_EQ(sum, 893.0);
}

TEST(ThesisColours, AnyNumberSumsToWhite) {
    for (const int count : {1, 7, 21}) {
        const optics::WavelengthSet set = thesisWavelengths(count);
        EXPECT_EQ(set.nm.size(), static_cast<std::size_t>(count));
        glm::dvec3 sum(0.0);
        for (const glm::dvec3& weight : set.xyz) sum += set.xyzToRgb * weight;
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(sum[k], 1.0, 1e-12);
    }
    const std::vector<double> red = {640.0, 680.0};   // no blue in either: shared
    const optics::WavelengthSet set = thesisWavelengthsAt(red);
    EXPECT_EQ(set.xyz[0].z, 0.5);
    EXPECT_NEAR(set.xyz[0].x + set.xyz[1].x, 1.0, 1e-12);
}

TEST(ThesisColours, OtherNumbersBecomeOneOfThree) {
    EXPECT_EQ(thesisWavelengthCount(kContinuous), 7);
    EXPECT_EQ(thesisWavelengthCount(1), 1);
    EXPECT_EQ(thesisWavelengthCount(7), 7);
    EXPECT_EQ(thesisWavelengthCount(13), 7);
    EXPECT_EQ(thesisWavelengthCount(41), 21);
}

}  // namespace
}  // namespace caustream::render
