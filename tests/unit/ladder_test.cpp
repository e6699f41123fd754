// The quality ladder: every step down is one, and a picture keeps its view's shape.
#include "stream/ladder.h"

#include <gtest/gtest.h>

namespace caustream::stream {
namespace {

TEST(Ladder, EveryStepDownGivesSomethingUpAndTakesNothingBack) {
    for (int level = Ladder::kBest + 1; level <= Ladder::kWorst; ++level) {
        const LadderLevel &above = Ladder::at(level - 1), &here = Ladder::at(level);
        EXPECT_LE(here.scale, above.scale) << level;
        EXPECT_LE(here.jpegQuality, above.jpegQuality) << level;
        EXPECT_GE(here.subsampling, above.subsampling) << level;
        EXPECT_LT(here.testBytes, above.testBytes) << level;
    }
}

TEST(Ladder, TheBestLevelIsTheViewsOwnSize) {
    EXPECT_EQ(Ladder::scaled({1280, 719}, Ladder::kBest), (Ladder::Size{1280, 719}));
    EXPECT_EQ(Ladder::at(Ladder::kBest).subsampling, Subsampling::None);
}

TEST(Ladder, PicturesKeepTheShapeToHalfAPixel) {
    for (int level = Ladder::kBest; level <= Ladder::kWorst; ++level) {
        for (int width = 32; width <= 4096; width = width * 3 / 2 + 1) {
            const Ladder::Size size = Ladder::scaled({width, 333}, level);
            EXPECT_NEAR(size.width, Ladder::at(level).scale * width, 0.5);
            EXPECT_NEAR(size.height, Ladder::at(level).scale * 333, 0.5);
        }
    }
}

TEST(Ladder, NoSideGetsShorterThanTheProtocolAllows) {
    EXPECT_EQ(Ladder::scaled({16, 24}, Ladder::kWorst), (Ladder::Size{16, 16}));
    EXPECT_EQ(Ladder::scaled({4096, 16}, Ladder::kWorst), (Ladder::Size{2048, 16}));
}

TEST(Ladder, LevelsBeyondTheEndsAreTheEnds) {
    EXPECT_EQ(&Ladder::at(-1), &Ladder::at(Ladder::kBest));
    EXPECT_EQ(&Ladder::at(Ladder::kFixed), &Ladder::at(Ladder::kWorst));
}

}  // namespace
}  // namespace caustream::stream
