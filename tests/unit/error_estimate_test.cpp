// The error estimate as a function of what the passes book.
#include "render/error_estimate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/spectral_spread.h"

namespace caustream::render {
namespace {

TEST(ErrorEstimate, NothingDiffersNothingIsWrong) {
    const ErrorEstimate error = estimateError({});
    EXPECT_EQ(error.sampling, 0.0);
    EXPECT_EQ(error.spectral, 0.0);
    EXPECT_EQ(error.total, 0.0);
}

TEST(ErrorEstimate, RisesWithEveryMeasure) {
    const ErrorEstimate few = estimateError({.halves = 0.02, .roughness = 0.05});
    EXPECT_GT(estimateError({.halves = 0.03, .roughness = 0.05}).sampling, few.sampling);
    EXPECT_GT(estimateError({.halves = 0.02, .roughness = 0.06}).sampling, few.sampling);
    // Independent causes: together more than either, less than their sum
    const double halves = estimateError({.halves = 0.02}).sampling, roughness = estimateError({.roughness = 0.05}).sampling;
    EXPECT_GT(few.sampling, std::max(halves, roughness));
    EXPECT_LT(few.sampling, halves + roughness);
}

TEST(ErrorEstimate, TheSpectralStepIsApartFromTheSampling) {
    const ErrorEstimate error = estimateError({.halves = 0.02, .spectralStep = 0.03});
    EXPECT_EQ(error.sampling, estimateError({.halves = 0.02}).sampling);
    EXPECT_EQ(error.spectral, 0.03);
    EXPECT_DOUBLE_EQ(error.total, std::hypot(error.sampling, 0.03));
}

// Exact wavelengths stand for the stretch around them, so that twice as many halve it; between the nodes of a continuous
// spectrum a bend is missed, a quarter of it with twice as many intervals.
TEST(SpectralStep, FallsWithTheNumberOfWavelengths) {
    const SpectralSpread spread{.ends = {0.5f, 0.25f}, .bend = {0.125f, 0.0f}, .flux = 1.0f};
    EXPECT_EQ(spectralStep(spread, 1, false, 512), glm::vec2(256.0f, 128.0f));
    EXPECT_EQ(spectralStep(spread, 4, false, 512), glm::vec2(64.0f, 32.0f));
    EXPECT_FLOAT_EQ(spectralStep(spread, 3, true, 512).x, 512.0f * 0.125f * 2.0f / 3.0f / 4.0f);
    EXPECT_FLOAT_EQ(spectralStep(spread, 5, true, 512).x, 0.25f * spectralStep(spread, 3, true, 512).x);
}

TEST(ErrorEstimate, EndsWhereMapsHaveNothingInCommon) {
    EXPECT_EQ(estimateError({.halves = 1.0, .roughness = 40.0}).total, 2.0);
}

}  // namespace
}  // namespace caustream::render
