// When and with what a client comes back, and how old what it shows is.
#include <gtest/gtest.h>

#include "client/connection/backoff.h"
#include "client/connection/closing.h"
#include "client/connection/frame_age.h"
#include "client/connection/kept_files.h"
#include "protocol/errors.h"

namespace caustream::connection {
namespace {

TEST(Backoff, DoublesFromAQuarterOfASecondToEight) {
    Backoff longest, shortest;
    for (const int bound : {250, 500, 1000, 2000, 4000, 8000, 8000, 8000}) {
        EXPECT_EQ(longest.next(1.0), bound);
        EXPECT_EQ(shortest.next(0.0), bound / 2);
    }
    longest.reset();
    EXPECT_EQ(longest.next(1.0), 250);
}

TEST(Backoff, AGoawaySaysWhen) {
    EXPECT_EQ(comeBackMs(500, 1000, 0.0), 500);
    EXPECT_EQ(comeBackMs(500, 1000, 0.5), 1000);
    EXPECT_EQ(comeBackMs(500, 0, 1.0), 500);
    EXPECT_EQ(comeBackMs(4'000'000'000u, 4'000'000'000u, 1.0), 60'000);
}

TEST(Closing, OnlyWhatAPersonMustPutRightEndsIt) {
    for (const int code : {0, 1001, 1006, 4408, 4429, 4500}) EXPECT_TRUE(closingOf(code, "broke").retry) << code;
    for (const int code : {4401, 4403, 4409, 4426, kBadCertificate}) {
        EXPECT_FALSE(closingOf(code, "why").retry) << code;
        EXPECT_FALSE(closingOf(code, "why").why.empty()) << code;
    }
}

protocol::FrameHeader frame(std::uint32_t inputSeq, std::uint64_t clientUs) {
    protocol::FrameHeader header;
    header.inputSeq = inputSeq;
    header.clientUs = clientUs;
    header.serverUs = 9'000'000;
    header.holdUs = 1000;
    header.renderUs = 20'000;
    header.encodeUs = 3000;
    return header;
}

TEST(FrameAge, IsOfTheInputThatAFrameIsTheFirstToShow) {
    FrameAge age;
    EXPECT_EQ(age.painted(frame(1, 1000), 51'000), 50.0);
    EXPECT_FALSE(age.painted(frame(1, 1000), 99'000)) << "the input was shown before, and no clock is known";
    EXPECT_EQ(age.painted(frame(2, 60'000), 99'000), 39.0);
}

TEST(FrameAge, IsElseTheServersTimeAndTheWay) {
    FrameAge age;
    // The server's clock is 8 s ahead; the way takes 5 ms, there and back 10.
    age.pong(990'000, 8'995'000, 1'000'000);
    age.pong(990'000, 9'995'000, 1'900'000);  // slower: says less
    // Handed over at 9.000 by its clock, 1.000 by ours.
    EXPECT_EQ(age.painted(frame(0, 0), 1'006'000), 6.0 + 24.0);
    EXPECT_FALSE(age.painted(frame(0, 0), 1'406'000)) << "nothing has changed: it converges";
    age.reset();
    EXPECT_FALSE(age.painted(frame(0, 0), 1'006'000)) << "another server's clock";
}

TEST(KeptFiles, ForgetTheOldestBeyondTheLimit) {
    const auto bytes = [](std::size_t size) { return std::make_shared<const std::vector<std::uint8_t>>(size); };
    KeptFiles files;
    files.put("a", bytes(40), 100);
    files.put("b", bytes(40), 100);
    files.put("a", bytes(40), 100);  // seen again: the newest
    files.put("c", bytes(40), 100);
    EXPECT_TRUE(files.get("a"));
    EXPECT_FALSE(files.get("b"));
    files.put("d", bytes(200), 100);
    EXPECT_EQ(files.get("d")->size(), 200u) << "what is shown is never forgotten";
    EXPECT_FALSE(files.get("c"));
}

}  // namespace
}  // namespace caustream::connection
