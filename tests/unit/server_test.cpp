// The parts of the server that decide without sockets, threads or a GPU.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "net/http.h"
#include "scheduler.h"
#include "session/outbox.h"
#include "session/token_bucket.h"

namespace caustream {
namespace {

using session::Outbox;
using session::OutgoingFrame;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::uint64_t kStill = Scheduler::kStillAfterUs;

Shown view(std::uint64_t changedUs, std::uint32_t rev = 1) {
    auto view = std::make_shared<View>();
    view->stream.maxFps = 100;
    return {.view = std::move(view), .rev = rev, .changedUs = changedUs};
}

class SchedulerTest : public testing::Test {
   protected:
    // A session that streams, with room for two frames.
    void streaming(SessionKey key, std::uint64_t nowUs) {
        scheduler_.add(key);
        scheduler_.show(key, view(nowUs));
        scheduler_.setStreaming(key, true);
        scheduler_.setOccupied(key, 0, 2, nowUs);
    }
    std::optional<FrameJob> next(std::uint64_t nowUs) { return scheduler_.next(nowUs, wakeUs_); }

    Scheduler scheduler_;
    std::uint64_t wakeUs_ = 0;
};

TEST_F(SchedulerTest, DrawsOncePerChangeThenOneStill) {
    streaming(1, 1000);
    const auto first = next(1000);
    ASSERT_TRUE(first);
    EXPECT_FALSE(first->still);
    EXPECT_FALSE(next(1000)) << "nothing changed";
    scheduler_.finished(*first);
    scheduler_.setOccupied(1, 0, 2, 2000);
    EXPECT_FALSE(next(2000));
    EXPECT_EQ(wakeUs_, 2000 + kStill);
    const auto still = next(2000 + kStill);
    ASSERT_TRUE(still);
    EXPECT_TRUE(still->still);
    scheduler_.finished(*still);
    EXPECT_FALSE(next(10 * kStill)) << "one still per pose";
    EXPECT_EQ(wakeUs_, 0u) << "sleeps until something changes";
}

TEST_F(SchedulerTest, NewInputPutsTheStillOff) {
    streaming(1, 1000);
    scheduler_.finished(*next(1000));
    scheduler_.show(1, view(1000 + kStill - 1));
    const auto job = next(1000 + kStill);
    ASSERT_TRUE(job);
    EXPECT_FALSE(job->still);
    EXPECT_FALSE(scheduler_.outdated(*job));
    scheduler_.show(1, view(1000 + kStill + 1));
    EXPECT_TRUE(scheduler_.outdated(*job));
}

TEST_F(SchedulerTest, NoRoomNoWork) {
    streaming(1, 1000);
    scheduler_.setOccupied(1, 2, 2, 1000);
    EXPECT_FALSE(next(1000));
    scheduler_.setOccupied(1, 1, 2, 1000);
    EXPECT_TRUE(next(1000));
    scheduler_.show(1, view(2000));
    EXPECT_FALSE(next(900'000)) << "one on its way, one being drawn: the window is full";
}

TEST_F(SchedulerTest, SessionsTakeTurns) {
    streaming(1, 1000);
    streaming(2, 1000);
    streaming(3, 1000);
    std::vector<SessionKey> order;
    for (std::uint64_t now = 100'000; order.size() < 6; now += 100'000) {
        for (SessionKey key : {1, 2, 3}) {
            scheduler_.show(key, view(now));
        }
        for (int i = 0; i < 3; ++i) {
            const auto job = next(now);
            ASSERT_TRUE(job);
            order.push_back(job->session);
            scheduler_.finished(*job);
        }
    }
    EXPECT_THAT(order, ElementsAre(1, 2, 3, 1, 2, 3));
}

TEST_F(SchedulerTest, KeepsToTheFrameRate) {
    streaming(1, 1000);
    scheduler_.finished(*next(1000));
    scheduler_.show(1, view(2000));
    EXPECT_FALSE(next(2000));
    EXPECT_EQ(wakeUs_, 11'000u) << "100 frames a second";
    EXPECT_TRUE(next(11'000));
}

TEST_F(SchedulerTest, ARequestNeedsNoStreamAndShowsItsOwnMoment) {
    scheduler_.add(1);
    scheduler_.show(1, view(1000, 5));
    EXPECT_TRUE(scheduler_.request(1, 9, true, false, 1000));
    scheduler_.show(1, view(2000, 6));
    const auto job = next(3000);
    ASSERT_TRUE(job);
    EXPECT_EQ(job->requestId, 9u);
    EXPECT_EQ(job->shown.rev, 5u);
    EXPECT_TRUE(job->still);
    EXPECT_FALSE(next(3000));
    for (std::size_t i = 0; i < Scheduler::kMaxRequests; ++i) {
        EXPECT_TRUE(scheduler_.request(1, 1, false, false, 3000));
    }
    EXPECT_FALSE(scheduler_.request(1, 1, false, false, 3000)) << "patience has an end";
}

TEST_F(SchedulerTest, WhatIsShownOrAskedForKeepsItsGeometry) {
    const auto of = [](const std::shared_ptr<scene::Geometry>& geometry) {
        auto lit = std::make_shared<scene::Scene>();
        lit->geometry = geometry;
        auto view = std::make_shared<View>();
        view->request.scene = lit;
        return Shown{.view = std::move(view), .rev = 1, .changedUs = 1000};
    };
    const auto first = std::make_shared<scene::Geometry>(), second = std::make_shared<scene::Geometry>();
    scheduler_.add(1);
    scheduler_.show(1, of(first));
    EXPECT_THAT(scheduler_.geometryShown(), ElementsAre(first.get()));
    scheduler_.request(1, 9, false, false, 1000);
    scheduler_.show(1, of(second));
    EXPECT_THAT(scheduler_.geometryShown(), ElementsAre(second.get(), first.get())) << "a frame of the first is still to be drawn";
    ASSERT_TRUE(next(1000));
    EXPECT_THAT(scheduler_.geometryShown(), ElementsAre(second.get()));
    scheduler_.remove(1);
    EXPECT_THAT(scheduler_.geometryShown(), ElementsAre());
}

TEST_F(SchedulerTest, TheGpuIsSharedByTimeNotByFrames) {
    streaming(1, 1000);
    streaming(2, 1000);
    std::map<SessionKey, double> usedMs;
    for (std::uint64_t now = 100'000; now < 20'000'000; now += 10'000) {
        for (SessionKey key : {1, 2}) {
            scheduler_.show(key, view(now));
        }
        if (const auto job = next(now)) {
            const std::uint64_t tookUs = job->session == 1 ? 90'000 : 10'000;
            scheduler_.spent(job->session, tookUs);
            scheduler_.finished(*job);
            usedMs[job->session] += 1e-3 * static_cast<double>(tookUs);
        }
    }
    EXPECT_NEAR(usedMs[1] / usedMs[2], 1.0, 0.1) << "one dear frame for nine cheap ones";
}

TEST_F(SchedulerTest, WhoeverWasAwayCatchesUpALittleAtMost) {
    streaming(1, 1000);
    streaming(2, 1000);
    scheduler_.finished(*next(1000));
    scheduler_.finished(*next(1000));
    for (std::uint64_t now = 100'000; now < 10'000'000; now += 50'000) {  // alone
        scheduler_.show(1, view(now));
        const auto job = next(now);
        ASSERT_TRUE(job);
        scheduler_.spent(job->session, 50'000);
        scheduler_.finished(*job);
    }
    int ofTheOther = 0;
    for (std::uint64_t now = 20'000'000; now < 21'000'000; now += 50'000) {
        for (SessionKey key : {1, 2}) {
            scheduler_.show(key, view(now));
        }
        const auto job = next(now);
        ASSERT_TRUE(job);
        ofTheOther += job->session == 2;
        scheduler_.spent(job->session, 50'000);
        scheduler_.finished(*job);
    }
    EXPECT_LE(ofTheOther, 13) << "half of twenty, and its credit";
    EXPECT_GE(ofTheOther, 10);
}

TEST_F(SchedulerTest, WhatMovesDoesNotStarveWhatRests) {
    streaming(1, 1000);
    streaming(2, 1000);
    scheduler_.finished(*next(1000));
    scheduler_.finished(*next(1000));
    scheduler_.setOccupied(2, 0, 2, 2000);
    bool still = false;
    for (std::uint64_t now = 100'000; now < 3'000'000 && !still; now += 50'000) {
        scheduler_.show(1, view(now));
        const auto job = next(now);
        ASSERT_TRUE(job);
        still = job->session == 2 && job->still;
        scheduler_.spent(job->session, 50'000);
        scheduler_.finished(*job);
    }
    EXPECT_TRUE(still);
}

TEST(SchedulerLimit, ASessionGetsNoMoreThanItsShareOfTheSecond) {
    Scheduler scheduler(200);
    std::uint64_t wakeUs = 0;
    scheduler.add(1);
    scheduler.show(1, view(1000));
    scheduler.setStreaming(1, true);
    scheduler.setOccupied(1, 0, 2, 1000);
    double usedMs = 0;
    for (std::uint64_t now = 1000; now < 10'001'000; now += 10'000) {
        scheduler.show(1, view(now));
        if (const auto job = scheduler.next(now, wakeUs)) {
            scheduler.spent(1, 50'000);
            scheduler.finished(*job);
            usedMs += 50;
        } else if (wakeUs > now + 10'000) {
            const auto refused = scheduler.request(1, 1, false, false, now);
            ASSERT_FALSE(refused);
            EXPECT_GT(refused.error().retryMs, 0u);
        }
    }
    EXPECT_NEAR(usedMs, 10 * 200 + 200, 100) << "and the first second's, at once";
}

TEST_F(SchedulerTest, APictureAtRestComesOnceMoreWithoutLoss) {
    const auto shown = [](std::uint64_t nowUs) {
        Shown plain = view(nowUs);
        auto adaptive = std::make_shared<View>(*plain.view);
        adaptive->adaptive = true;
        adaptive->encodeLast.encoding = protocol::Encoding::Png;
        plain.view = adaptive;
        return plain;
    };
    scheduler_.add(1);
    scheduler_.show(1, shown(1000));
    scheduler_.setStreaming(1, true);
    scheduler_.setOccupied(1, 0, 2, 1000);
    scheduler_.setLevel(1, 4);
    const auto moving = next(1000);
    ASSERT_TRUE(moving);
    EXPECT_EQ(moving->level, 4);
    scheduler_.finished(*moving);
    const auto still = next(1000 + kStill);
    ASSERT_TRUE(still);
    EXPECT_TRUE(still->still && !still->lossless);
    EXPECT_EQ(still->level, stream::Ladder::kFixed) << "as large as the view";
    scheduler_.finished(*still);
    EXPECT_FALSE(next(1000 + Scheduler::kLosslessAfterUs - 1));
    EXPECT_EQ(wakeUs_, 1000 + Scheduler::kLosslessAfterUs);
    const auto lossless = next(1000 + Scheduler::kLosslessAfterUs);
    ASSERT_TRUE(lossless);
    EXPECT_TRUE(lossless->still && lossless->lossless);
    scheduler_.finished(*lossless);
    EXPECT_FALSE(next(100 * Scheduler::kLosslessAfterUs)) << "once each";

    scheduler_.show(1, shown(200'000'000));
    scheduler_.finished(*next(200'000'000));
    scheduler_.show(1, shown(200'000'000 + Scheduler::kLosslessAfterUs / 2));
    const auto after = next(200'000'000 + Scheduler::kLosslessAfterUs);
    ASSERT_TRUE(after);
    EXPECT_FALSE(after->still) << "input puts both off";
}

OutgoingFrame frame(std::uint32_t rev, std::uint32_t flags = 0) {
    OutgoingFrame frame;
    frame.buffer = stream::WireBuffer(protocol::kFrameHeaderBytes + 16);
    frame.header.width = frame.header.height = frame.header.viewWidth = frame.header.viewHeight = 16;
    frame.header.rawLen = 16 * 16 * 3;
    frame.header.payloadLen = 16;
    frame.header.encoding = protocol::Encoding::Jpeg;
    frame.header.stateRev = rev;
    frame.header.flags = flags;
    frame.info.width = frame.info.height = 16;
    return frame;
}

// The next message: a text's op, or "frame <seq> <rev>".
std::string leave(Outbox& outbox, std::uint64_t nowUs = 1) {
    auto message = outbox.next(nowUs);
    if (!message) {
        return "";
    }
    const auto bytes = message->buffer.bytes();
    if (!message->binary) {
        return protocol::Json::parse(bytes.begin(), bytes.end())["op"];
    }
    const auto header = protocol::decodeFrameHeader(bytes);
    return header ? "frame " + std::to_string(header->frameSeq) + " " + std::to_string(header->stateRev) : header.error().message;
}

TEST(OutboxTest, TheEpochsDescriptionGoesFirstAndOnce) {
    Outbox outbox;
    outbox.text(R"({"op":"ok"})");
    outbox.streamed(1, frame(1));
    EXPECT_EQ(leave(outbox), "ok");
    EXPECT_EQ(leave(outbox), "stream.info");
    EXPECT_EQ(leave(outbox), "frame 1 1");
    outbox.streamed(2, frame(2));
    EXPECT_EQ(leave(outbox), "frame 2 2");
    EXPECT_EQ(leave(outbox), "");
}

TEST(OutboxTest, TheWindowHoldsAndTheNewestWins) {
    Outbox outbox;
    outbox.setMaxInflight(8);
    for (std::uint32_t rev = 1; rev <= 2; ++rev) {
        outbox.streamed(rev, frame(rev));
        while (outbox.occupied() > outbox.unacknowledged()) {
            leave(outbox);
        }
    }
    outbox.streamed(3, frame(3));
    outbox.streamed(5, frame(5));
    outbox.streamed(4, frame(4));
    EXPECT_EQ(leave(outbox), "") << "two are out";
    EXPECT_EQ(outbox.dropped(), 2u);
    EXPECT_FALSE(outbox.acknowledge({.seq = 7}, 5)) << "never sent";
    EXPECT_TRUE(outbox.acknowledge({.seq = 1}, 5));
    EXPECT_EQ(leave(outbox), "frame 3 5");
}

TEST(OutboxTest, AnAnswerPassesTheWindowWithItsReply) {
    Outbox outbox;
    outbox.setMaxInflight(1);
    outbox.streamed(1, frame(1));
    leave(outbox);
    EXPECT_EQ(leave(outbox), "frame 1 1");
    OutgoingFrame answer = frame(2);
    answer.requestId = 4;
    outbox.requested(std::move(answer));
    EXPECT_EQ(leave(outbox), "stats");
    EXPECT_EQ(leave(outbox), "ok");
    EXPECT_EQ(leave(outbox), "frame 2 2");
    EXPECT_EQ(outbox.unacknowledged(), 1u);
}

TEST(OutboxTest, InputDiscardsAWaitingStill) {
    Outbox outbox;
    OutgoingFrame still = frame(1, protocol::kFrameStill);
    still.resting = true;
    outbox.streamed(1, std::move(still));
    outbox.discardResting();
    EXPECT_EQ(leave(outbox), "");
    outbox.streamed(2, frame(2));
    outbox.discardResting();
    EXPECT_EQ(leave(outbox), "stream.info");
}

TEST(OutboxTest, WhatRestsLeavesRoomForWhatMoves) {
    const auto resting = [](std::uint32_t rev) {
        OutgoingFrame outgoing = frame(rev);
        outgoing.resting = true;
        return outgoing;
    };
    Outbox outbox;
    outbox.streamed(1, resting(1));
    leave(outbox);
    EXPECT_EQ(leave(outbox), "frame 1 1");
    outbox.streamed(2, resting(1));
    EXPECT_EQ(leave(outbox), "") << "one is on its way, the other place is for what moves";
    EXPECT_EQ(outbox.occupied(), 2u);
    outbox.discardResting();
    outbox.streamed(3, frame(2));
    EXPECT_EQ(leave(outbox), "frame 2 2");
    outbox.acknowledge({.seq = 2}, 5);
    outbox.streamed(4, resting(2));
    EXPECT_EQ(leave(outbox), "frame 3 2");

    Outbox narrow;
    narrow.setMaxInflight(1);
    narrow.streamed(1, resting(1));
    leave(narrow);
    EXPECT_EQ(leave(narrow), "frame 1 1") << "a window of one has no place to spare";
}

TEST(TokenBucketTest, LetsABurstAndThenTheRateThrough) {
    session::TokenBucket bucket(10);
    int taken = 0;
    for (int i = 0; i < 20; ++i) {
        taken += bucket.take(1000);
    }
    EXPECT_EQ(taken, 10);
    EXPECT_TRUE(bucket.take(1000 + 100'000));
    EXPECT_FALSE(bucket.take(1000 + 100'001));
}

TEST(HttpTest, FilesByName) {
    const embedded::File files[] = {{"index.html", "<p>"}, {"app.js", "1;"}};
    EXPECT_EQ(net::pageFile(files, {"/", ""}).body, "<p>");
    EXPECT_EQ(net::pageFile(files, {"/app.js", ""}).contentType, "text/javascript; charset=utf-8");
    EXPECT_EQ(net::pageFile(files, {"/other", ""}).status, 404);
    const std::string etag = net::pageFile(files, {"/app.js", ""}).etag;
    EXPECT_EQ(net::pageFile(files, {"/app.js", etag}).status, 304);
    EXPECT_NE(net::pageFile(files, {"/", ""}).etag, etag);
}

TEST(HttpTest, WhoMayTalk) {
    EXPECT_TRUE(net::sameHost("", "127.0.0.1:9"));
    EXPECT_TRUE(net::sameHost("http://127.0.0.1:9", "127.0.0.1:9"));
    EXPECT_FALSE(net::sameHost("http://127.0.0.1:8", "127.0.0.1:9"));
    EXPECT_FALSE(net::sameHost("null", "127.0.0.1:9"));
    for (const char* host : {"localhost", "localhost:9", "127.0.0.1:9", "[::1]:9", "viewer.localhost"}) {
        EXPECT_TRUE(net::isLocalName(host)) << host;
    }
    for (const char* host : {"", "evil.example", "127.0.0.1.evil.example:9", "localhost.evil.example", "[evil.example]"}) {
        EXPECT_FALSE(net::isLocalName(host)) << host;
    }
}

}  // namespace
}  // namespace caustream
