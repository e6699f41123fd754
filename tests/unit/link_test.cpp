// The slow network of the stream benches: as fast as it says and no faster, in order, late by its length. Simulated time.
#include "bench/stream/link.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace caustream::bench {
namespace {

constexpr std::uint64_t kStartUs = 1'000'000;

// Offers as much as the link takes, whenever an irregular clock ticks, from `fromUs` on; what arrived within `us`.
std::size_t offered(Link& link, std::uint64_t fromUs, std::uint64_t us, std::mt19937& engine) {
    std::size_t arrived = 0;
    for (std::uint64_t now = fromUs; now < fromUs + us; now += 50 + engine() % 4000) {
        link.enter(std::string(link.room(now), 'x'), now);
        while (!link.arrived(now).empty()) {
            arrived += link.arrived(now).size();
            link.leave(link.arrived(now).size());
        }
    }
    return arrived;
}

TEST(Link, PassesWhatItsRateSays) {
    for (const double rate : {2e7, 2e6, 6e5, 2e4}) {
        std::mt19937 engine{7};
        Link link;
        link.reshape({.bytesPerS = rate}, kStartUs);
        const auto bytes = static_cast<double>(offered(link, kStartUs, 10'000'000, engine));
        EXPECT_NEAR(bytes, 10 * rate, 0.02 * rate + 3000) << rate;   // a burst is 10 ms' worth, and a packet
    }
}

TEST(Link, AnotherRateHoldsFromThenOn) {
    std::mt19937 engine{7};
    Link link;
    link.reshape({.bytesPerS = 2e7}, kStartUs);
    offered(link, kStartUs, 1'000'000, engine);
    link.reshape({.bytesPerS = 2e6}, kStartUs + 1'010'000);
    const auto slow = static_cast<double>(offered(link, kStartUs + 1'010'000, 2'000'000, engine));
    EXPECT_NEAR(slow, 4e6, 6e4);
    link.reshape({.bytesPerS = 8e6}, kStartUs + 3'020'000);
    EXPECT_NEAR(static_cast<double>(offered(link, kStartUs + 3'020'000, 2'000'000, engine)), 1.6e7, 2e5);
}

// Nothing is saved up while nothing is offered, beyond one burst.
TEST(Link, IdleTimeIsLost) {
    Link link;
    link.reshape({.bytesPerS = 1e6}, kStartUs);
    EXPECT_LE(link.room(kStartUs + 60'000'000), 10'000u);
}

TEST(Link, BytesArriveInOrderAndLateByItsLength) {
    Link link;
    link.reshape({.bytesPerS = 0, .delayUs = 100'000}, kStartUs);
    link.enter("first ", kStartUs);
    link.enter("second", kStartUs + 10'000);
    EXPECT_EQ(link.arrived(kStartUs + 99'999), "");
    EXPECT_EQ(link.nextUs(kStartUs + 50'000), kStartUs + 100'000);
    EXPECT_EQ(link.arrived(kStartUs + 100'000), "first ");
    link.leave(4);
    EXPECT_EQ(link.arrived(kStartUs + 100'000), "t ");
    link.leave(2);
    EXPECT_EQ(link.arrived(kStartUs + 100'000), "");
    // A shorter path does not let what comes later overtake.
    link.reshape({.bytesPerS = 0, .delayUs = 0}, kStartUs + 20'000);
    link.enter("third", kStartUs + 20'000);
    EXPECT_EQ(link.arrived(kStartUs + 109'999), "");
    EXPECT_EQ(link.arrived(kStartUs + 110'000), "second");
    link.leave(6);
    EXPECT_EQ(link.arrived(kStartUs + 110'000), "third");
}

// A reader that stops: what waits stays with the sender, not in the link.
TEST(Link, HoldsNoMoreThanItsLength) {
    Link link;
    link.reshape({.bytesPerS = 2e6, .delayUs = 100'000}, kStartUs);
    std::size_t held = 0;
    for (std::uint64_t now = kStartUs; now < kStartUs + 5'000'000; now += 1000) {
        const std::size_t room = link.room(now);
        link.enter(std::string(room, 'x'), now);
        held += room;
    }
    EXPECT_GE(held, 200'000u) << "a link's length is full of bytes";
    EXPECT_LE(held, 200'000u + (64u << 10) + 20'000u);
    EXPECT_EQ(link.nextUs(kStartUs + 5'000'000), 0u) << "only its reader can change that";
}

// Over every step: what the relay would sleep until is when there is room again.
TEST(Link, SaysWhenToLookAgain) {
    Link link;
    link.reshape({.bytesPerS = 6e5}, kStartUs);
    std::uint64_t now = kStartUs + 1000;
    for (int i = 0; i < 100; ++i) {
        link.enter(std::string(link.room(now), 'x'), now);
        while (!link.arrived(now).empty()) link.leave(link.arrived(now).size());
        EXPECT_EQ(link.room(now), 0u);
        now = link.nextUs(now);
        ASSERT_GT(now, 0u);
        EXPECT_GT(link.room(now), 0u);
    }
}

}  // namespace
}  // namespace caustream::bench
