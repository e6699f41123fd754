// A viewer of the stream benches: moves something at a steady pace, acknowledges every frame the moment its last byte is
// here, decodes none, and writes down when what came.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "protocol/messages.h"
#include "tests/e2e/raw_client.h"

namespace caustream::bench {

struct Arrival {
    std::uint64_t atUs = 0;      // last byte received, our clock
    double ageMs = 0;            // since we sent the newest input that it shows; < 0: it shows none
    std::size_t bytes = 0;       // of the message
    protocol::FrameHeader header;
};

struct WatchOptions {
    double inputsPerS = 60;
    std::uint64_t untilUs = 0;                    // our clock
    std::uint64_t phaseUs = 0;                    // of the inputs within their period, which begins at 0 of our clock
    const std::atomic<bool>* stop = nullptr;      // ends it early
    std::uint32_t firstSeq = 1;                   // of the inputs: one connection can be watched twice
    // What input number `seq` changes; by default it moves the camera a little, each time to another place.
    std::function<protocol::Json(std::uint32_t seq)> pose;
};

struct Watched {
    std::vector<Arrival> frames;
    std::vector<protocol::Json> stats;
    std::uint32_t lastInput = 0, lastShown = 0;   // numbers: sent, and in the newest frame's header
    std::string ended;                            // why, where the connection did; empty: it is there
};

// The scene small and cheap, the picture of a size at which it counts as one, quality fixed or "auto".
protocol::Json plainDocument(bool autoQuality, int side = 256);

Watched watch(e2e::RawClient& client, const WatchOptions& options);

// A whole viewer: connects to `port`, says hello and the document, streams, watches.
Watched watchStream(int port, const protocol::Json& document, const WatchOptions& options);

// Of what arrived from `fromUs` on and before `toUs`.
std::vector<double> agesMs(const std::vector<Arrival>& frames, std::uint64_t fromUs = 0, std::uint64_t toUs = ~std::uint64_t{0});

}  // namespace caustream::bench
