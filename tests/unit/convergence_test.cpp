// When a picture that rests goes on converging, and when it has to wait: the scheduler with a clock and results of our own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scheduler.h"

namespace caustream {
namespace {

using testing::ElementsAre;

constexpr std::uint64_t kRest = Scheduler::kConvergeAfterUs, kStill = Scheduler::kStillAfterUs;
constexpr std::uint64_t kFrame = 10'000;  // at the 100 frames a second of these views

Shown view(std::uint64_t changedUs, render::Target target = render::Target::Composite) {
    auto view = std::make_shared<View>();
    view->stream.maxFps = 100;
    view->request.target = target;
    return {.view = std::move(view), .rev = 1, .changedUs = changedUs};
}

std::optional<render::Convergence> reached(double progress) {
    return render::Convergence{.photons = 1000, .progress = progress, .converged = progress >= 1.0};
}

class ConvergenceTest : public testing::Test {
   protected:
    void streaming(SessionKey key, std::uint64_t nowUs, render::Target target = render::Target::Composite) {
        scheduler_.add(key);
        scheduler_.show(key, view(nowUs, target));
        scheduler_.setStreaming(key, true);
        scheduler_.setOccupied(key, 0, 2, nowUs);
    }
    std::optional<FrameJob> next(std::uint64_t nowUs) { return scheduler_.next(nowUs, wakeUs_); }
    // Drawn, sent and acknowledged at once.
    void done(const FrameJob& job, std::uint64_t nowUs, const std::optional<render::Convergence>& convergence) {
        scheduler_.drawn(job, convergence);
        scheduler_.finished(job);
        scheduler_.setOccupied(job.session, 0, 2, nowUs);
    }
    // The first frame after a change, with something left to converge.
    void first(SessionKey key, std::uint64_t nowUs) {
        streaming(key, nowUs);
        done(*next(nowUs), nowUs, reached(0.1));
    }

    Scheduler scheduler_;
    std::uint64_t wakeUs_ = 0;
};

TEST_F(ConvergenceTest, GoesOnUntilItHasConvergedAndThenShowsOneStill) {
    streaming(1, 1000);
    const auto moving = next(1000);
    ASSERT_TRUE(moving);
    EXPECT_FALSE(moving->converge);
    done(*moving, 1000, reached(0.1));
    EXPECT_FALSE(next(1000)) << "a hand may still move";
    EXPECT_EQ(wakeUs_, 1000 + kRest);
    std::uint64_t now = 1000 + kRest;
    for (const double progress : {0.4, 0.7, 1.0}) {
        const auto job = next(now);
        ASSERT_TRUE(job) << progress;
        EXPECT_TRUE(job->converge);
        EXPECT_FALSE(job->still);
        EXPECT_TRUE(job->resting());
        EXPECT_FALSE(job->endsConvergence(reached(progress))) << "of a picture the still is the last";
        done(*job, now, reached(progress));
        EXPECT_FALSE(next(now)) << "no faster than max_fps";
        EXPECT_EQ(wakeUs_, now + kFrame);
        now += kFrame;
    }
    const auto last = next(now);
    ASSERT_TRUE(last);
    EXPECT_TRUE(last->still && last->converge);
    EXPECT_TRUE(last->endsConvergence(reached(1.0)));
    done(*last, now, reached(1.0));
    EXPECT_FALSE(next(now + 100 * kStill)) << "once";
    EXPECT_EQ(wakeUs_, 0u) << "sleeps until something changes";
}

TEST_F(ConvergenceTest, WhatHasNothingToConvergeKeepsItsStill) {
    streaming(1, 1000);
    done(*next(1000), 1000, std::nullopt);
    EXPECT_FALSE(next(1000 + kRest));
    const auto still = next(1000 + kStill);
    ASSERT_TRUE(still);
    EXPECT_TRUE(still->still);
    EXPECT_FALSE(still->converge);
    EXPECT_FALSE(still->endsConvergence(std::nullopt));
    done(*still, 1000 + kStill, std::nullopt);
    EXPECT_FALSE(next(100 * kStill));
}

// The map's light has rested, the camera has not: its photons are all there.
TEST_F(ConvergenceTest, AMapThatHasConvergedBeforeGetsItsLastFrameAtOnce) {
    streaming(1, 1000);
    done(*next(1000), 1000, reached(1.0));
    EXPECT_FALSE(next(1000 + kRest - 1));
    const auto last = next(1000 + kRest);
    ASSERT_TRUE(last);
    EXPECT_TRUE(last->still && last->converge);
    done(*last, 1000 + kRest, reached(1.0));
    EXPECT_FALSE(next(100 * kStill));
}

TEST_F(ConvergenceTest, TheSpectralMapsLastFrameIsTheOneThatConverged) {
    streaming(1, 1000, render::Target::Spectral);
    done(*next(1000), 1000, reached(0.1));
    const auto job = next(1000 + kRest);
    ASSERT_TRUE(job);
    EXPECT_TRUE(job->converge);
    EXPECT_TRUE(job->endsConvergence(reached(1.0)));
    done(*job, 1000 + kRest, reached(1.0));
    EXPECT_FALSE(next(100 * kStill)) << "a map has no anti-aliasing to come";

    // Where the first frame has converged already, one more says so.
    scheduler_.show(1, view(101 * kStill, render::Target::Spectral));
    done(*next(101 * kStill), 101 * kStill, reached(1.0));
    const auto last = next(102 * kStill);
    ASSERT_TRUE(last);
    EXPECT_TRUE(last->converge && !last->still);
    EXPECT_TRUE(last->endsConvergence(reached(1.0)));
    done(*last, 102 * kStill, reached(1.0));
    EXPECT_FALSE(next(200 * kStill));
}

TEST_F(ConvergenceTest, InputStopsItAndItStartsAnew) {
    first(1, 1000);
    const auto converging = next(1000 + kRest);
    ASSERT_TRUE(converging);
    const std::uint64_t input = 1000 + kRest + 1;
    scheduler_.show(1, view(input));
    EXPECT_TRUE(scheduler_.outdated(*converging)) << "it is not sent any more";
    // Nothing is known of the new picture from the old one's frame.
    done(*converging, input, reached(1.0));
    const auto moving = next(input);
    ASSERT_TRUE(moving);
    EXPECT_FALSE(moving->converge || moving->still);
    done(*moving, input, reached(0.1));
    EXPECT_FALSE(next(input + kRest - 1));
    const auto again = next(input + kRest);
    ASSERT_TRUE(again);
    EXPECT_TRUE(again->converge && !again->still);
}

// What is being drawn is waited for, its acknowledgement, its encoder and its max_fps are not.
TEST_F(ConvergenceTest, TheFirstFrameAfterAnInputIsNotHeldBack) {
    first(1, 1000);
    const std::uint64_t now = 1000 + kRest;
    const auto sent = next(now);
    ASSERT_TRUE(sent);
    scheduler_.drawn(*sent, reached(0.3));
    scheduler_.finished(*sent);
    scheduler_.setOccupied(1, 1, 2, now);  // on its way, not acknowledged
    const auto drawing = next(now + kFrame);
    ASSERT_TRUE(drawing) << "the next is drawn meanwhile";
    EXPECT_TRUE(drawing->converge);
    scheduler_.drawn(*drawing, reached(0.4));
    EXPECT_FALSE(next(now + 5 * kFrame)) << "the window is full";

    const std::uint64_t input = now + kFrame + 1;
    scheduler_.show(1, view(input));
    const auto moving = next(input);
    ASSERT_TRUE(moving) << "at once: that frame will not be sent";
    EXPECT_FALSE(moving->resting());
}

TEST_F(ConvergenceTest, IsPacedByTheWindow) {
    first(1, 1000);
    std::uint64_t now = 1000 + kRest;
    scheduler_.setOccupied(1, 2, 2, now);
    EXPECT_FALSE(next(now));
    scheduler_.setOccupied(1, 0, 1, now);
    const auto job = next(now);
    ASSERT_TRUE(job);
    scheduler_.drawn(*job, reached(0.2));
    now += 10 * kFrame;
    EXPECT_FALSE(next(now)) << "a window of one holds the one that is encoded";
    scheduler_.finished(*job);
    scheduler_.setOccupied(1, 1, 1, now);
    EXPECT_FALSE(next(now)) << "or on its way";
    scheduler_.setOccupied(1, 0, 1, now);
    EXPECT_TRUE(next(now));
    scheduler_.setStreaming(1, false);
    EXPECT_FALSE(next(now + 10 * kFrame)) << "a stream that pauses does not converge";
}

TEST_F(ConvergenceTest, WhatMovesGoesFirstThenStillsAndThoseAtRestTakeTurns) {
    first(1, 1000);
    first(2, 1000);
    std::uint64_t now = 1000 + kRest;
    std::vector<SessionKey> order;
    for (int i = 0; i < 4; ++i, now += kFrame) {
        const auto job = next(now);
        ASSERT_TRUE(job);
        EXPECT_TRUE(job->converge);
        order.push_back(job->session);
        done(*job, now, reached(0.2));
    }
    EXPECT_THAT(order, ElementsAre(1, 2, 1, 2));

    // A third one moves; whoever rests gets what it leaves, still in turns.
    streaming(3, now);
    order.clear();
    for (int i = 0; i < 4; ++i) {
        for (int frame = 0; frame < 2; ++frame, now += kFrame) {
            const auto job = next(now);
            ASSERT_TRUE(job);
            order.push_back(job->session);
            done(*job, now, reached(0.2));
        }
        scheduler_.show(3, view(now));
    }
    EXPECT_THAT(order, ElementsAre(3, 1, 3, 2, 3, 1, 3, 2));

    // And a still, which is one frame, before what takes many.
    done(*next(now), now, std::nullopt);
    now += kStill;
    const auto still = next(now);
    ASSERT_TRUE(still);
    EXPECT_TRUE(still->still && !still->converge);
    EXPECT_EQ(still->session, 3u);
}

TEST_F(ConvergenceTest, AnAnswerToARequestSaysNothingOfTheStream) {
    first(1, 1000);
    ASSERT_TRUE(scheduler_.request(1, 7, true, true, 1000));
    const auto answer = next(2000);
    ASSERT_TRUE(answer && answer->requestId && answer->converge);
    EXPECT_FALSE(answer->resting());
    EXPECT_FALSE(answer->endsConvergence(reached(1.0)));
    scheduler_.drawn(*answer, reached(1.0));
    scheduler_.finished(*answer);
    const auto job = next(1000 + kRest);
    ASSERT_TRUE(job);
    EXPECT_TRUE(job->converge && !job->still);
}

// Another viewer's light may push a map out of the renderer's cache: then its photons are to be traced again.
TEST_F(ConvergenceTest, AMapThatIsLostIsConvergedOnceMore) {
    first(1, 1000);
    std::uint64_t now = 1000 + kRest;
    done(*next(now), now, reached(1.0));
    const auto last = next(now += kFrame);
    ASSERT_TRUE(last && last->still);
    EXPECT_FALSE(last->endsConvergence(reached(0.1)));
    done(*last, now, reached(0.1));
    const auto again = next(now += kFrame);
    ASSERT_TRUE(again);
    EXPECT_TRUE(again->converge && !again->still);
    done(*again, now, reached(1.0));
    EXPECT_TRUE(next(now += kFrame)->still);
}

TEST_F(ConvergenceTest, AFrameThatCannotBeDrawnIsNotTriedForEver) {
    first(1, 1000);
    const auto job = next(1000 + kRest);
    ASSERT_TRUE(job);
    done(*job, 1000 + kRest, std::nullopt);
    EXPECT_FALSE(next(100 * kStill));
    scheduler_.redrawAll();
    const auto redrawn = next(101 * kStill);
    ASSERT_TRUE(redrawn);
    done(*redrawn, 101 * kStill, reached(0.2));
    EXPECT_TRUE(next(102 * kStill)->converge) << "until the shaders are put right";
}

}  // namespace
}  // namespace caustream
