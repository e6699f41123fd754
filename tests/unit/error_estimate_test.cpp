// The error estimate as a function of what the passes book.
#include "render/error_estimate.h"

#include <gtest/gtest.h>

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

TEST(ErrorEstimate, EndsWhereMapsHaveNothingInCommon) {
    EXPECT_EQ(estimateError({.halves = 1.0, .roughness = 40.0}).total, 2.0);
}

}  // namespace
}  // namespace caustream::render
