// The window and the quality ladder against a simulated link: a pipe with a rate, a propagation time and a queue.
#include "stream/rate_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <vector>

namespace caustream::stream {
namespace {

// A server that offers a frame whenever the window lets it, to a viewer behind a link. Time in microseconds.
class Simulation {
   public:
    RateController controller;
    double bytesPerS = 2e6;
    double oneWayUs = 0.0;
    double frameBytes = 100e3;   // at the best level
    double fps = 60.0;
    double pictureMs = 0.0;      // at full size
    bool ladder = true;

    std::vector<double> ages;    // ms, of the frames acknowledged since run() began
    double delivered = 0.0;      // bytes

    void run(double seconds) {
        ages.clear();
        delivered = 0.0;
        const double end = now_ + seconds * 1e6;
        while (now_ < end) {
            const bool room = onTheWay_.size() < controller.window();
            const double nextSend = room ? std::max(now_, notBefore_) : end;
            const double nextAck = onTheWay_.empty() ? end : onTheWay_.front().ackUs;
            now_ = std::min({nextSend, nextAck, end});
            if (now_ >= end) {
                return;
            }
            nextAck <= nextSend ? acknowledge() : send();
        }
    }
    double medianAge() const {
        std::vector<double> sorted = ages;
        std::ranges::sort(sorted);
        return sorted.empty() ? 0.0 : sorted[sorted.size() / 2];
    }

   private:
    struct Frame {
        RateController::Sent sent;
        double ackUs;
    };
    void send() {
        const int level = ladder ? controller.level() : Ladder::kFixed;
        const double scale = ladder ? Ladder::at(level).scale : 1.0;
        const auto bytes = static_cast<std::size_t>(frameBytes * (ladder ? Ladder::at(level).testBytes : 1.0));
        const auto at = static_cast<std::uint64_t>(now_);
        const auto sent = controller.sent(at, bytes, level, pictureMs * scale * scale, static_cast<std::uint32_t>(onTheWay_.size()));
        linkFreeUs_ = std::max(linkFreeUs_, now_ + oneWayUs) + 1e6 * static_cast<double>(bytes) / bytesPerS;
        onTheWay_.push_back({sent, linkFreeUs_ + oneWayUs});
        notBefore_ = now_ + 1e6 / fps;
    }
    void acknowledge() {
        const Frame frame = onTheWay_.front();
        onTheWay_.pop_front();
        controller.acknowledged(frame.sent, frame.sent.bytes, static_cast<std::uint64_t>(now_));
        ages.push_back((now_ - static_cast<double>(frame.sent.atUs)) * 1e-3);
        delivered += static_cast<double>(frame.sent.bytes);
    }

    double now_ = 1e6, notBefore_ = 0.0, linkFreeUs_ = 0.0;
    std::deque<Frame> onTheWay_;
};

Simulation simulation() {
    Simulation link;
    link.controller.setMaxInflight(8);
    link.controller.setFrameRate(60.0);
    return link;
}

TEST(RateController, ALinkWithoutDelayHoldsTwoFramesAndIsFull) {
    Simulation link = simulation();
    link.ladder = false;
    link.run(3);
    link.run(30);
    EXPECT_EQ(link.controller.window(), 2u);
    EXPECT_LE(link.medianAge(), 2.1 * 50.0) << "one frame takes 50 ms";
    EXPECT_GE(link.delivered / 30, 0.95 * 2e6);
}

TEST(RateController, ALongLinkIsKeptFull) {
    Simulation link = simulation();
    link.ladder = false;
    link.oneWayUs = 100e3;
    link.run(3);
    link.run(30);
    EXPECT_EQ(link.controller.window(), 6u) << "200 ms hold four frames of 50 ms, and two";
    EXPECT_GE(link.delivered / 30, 0.9 * 2e6) << "frames that travel alone, to measure, cost a little";
    EXPECT_LE(link.medianAge(), 200.0 + 2.5 * 50.0);
}

TEST(RateController, AFastLongLinkHoldsWhatTheFrameRateNeeds) {
    Simulation link = simulation();
    link.oneWayUs = 20e3;
    link.bytesPerS = 1e9;
    link.run(10);
    EXPECT_EQ(link.controller.window(), 4u) << "40 ms hold more than two frames of a sixtieth of a second, and one is drawn";
}

TEST(RateController, AViewerThatTakesOneFrameGetsOne) {
    Simulation link = simulation();
    link.controller.setMaxInflight(1);
    link.oneWayUs = 100e3;
    link.run(5);
    EXPECT_EQ(link.controller.window(), 1u);
}

TEST(RateController, AQueueIsNotTakenForADistance) {
    // Nothing travels alone but what is made to: the base must not creep up with the window that it sets.
    Simulation link = simulation();
    link.ladder = false;
    link.bytesPerS = 0.5e6;
    link.run(120);
    EXPECT_EQ(link.controller.window(), 2u);
    EXPECT_LE(link.medianAge(), 2.1 * 200.0);
}

TEST(RateController, TheLadderFollowsTheLinkDownAndUp) {
    Simulation link = simulation();
    link.bytesPerS = 20e6;
    link.run(15);
    EXPECT_EQ(link.controller.level(), Ladder::kBest);
    for (const double rate : {2e6, 0.6e6}) {
        link.bytesPerS = rate;
        link.run(2);
        link.run(1);
        EXPECT_LE(link.medianAge(), 150.0) << rate;
        link.run(12);
        EXPECT_LE(link.medianAge(), 150.0) << rate;
    }
    EXPECT_GE(link.controller.level(), 3) << "what 600 kB/s carry 20 times a second";
    link.bytesPerS = 4e6;
    link.run(10);
    EXPECT_EQ(link.controller.level(), Ladder::kBest);
    EXPECT_LE(link.medianAge(), 150.0);
}

TEST(RateController, AClimbThatFailsIsTriedLessOften) {
    Simulation link = simulation();
    link.bytesPerS = 1.3e6;  // the best level's frames take 77 ms, the next one's 55, then 46
    link.run(5);
    const int settled = link.controller.level();
    EXPECT_GT(settled, Ladder::kBest);
    int above = 0;
    for (int i = 0; i < 300; ++i) {
        link.run(0.1);
        above += link.controller.level() < settled;
    }
    EXPECT_LT(above, 60) << "of 300 looks in 30 s";
}

TEST(RateController, PicturesThatTakeLongToDrawShrink) {
    Simulation link = simulation();
    link.bytesPerS = 1e9;
    link.pictureMs = 200.0;
    link.run(3);
    EXPECT_EQ(link.controller.level(), Ladder::kWorst) << "a quarter of the pixels takes 50 ms";
    link.pictureMs = 20.0;
    link.run(10);
    EXPECT_EQ(link.controller.level(), Ladder::kBest);
}

TEST(RateController, FramesOffTheLadderDoNotMoveIt) {
    Simulation link = simulation();
    link.ladder = false;
    link.bytesPerS = 0.2e6;
    link.run(20);
    EXPECT_EQ(link.controller.level(), Ladder::kBest);
}

}  // namespace
}  // namespace caustream::stream
