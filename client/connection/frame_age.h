// How old what a frame shows is when it is on the screen: since the input that it shows, by our clock, or since the
// change that it shows, by the server's.
#pragma once
#include <cstdint>
#include <optional>

#include "protocol/frame_header.h"

namespace caustream::connection {

class FrameAge {
 public:
    // From a pong: our clock when the ping left and when the pong came, the server's in between.
    void pong(std::uint64_t sentUs, std::uint64_t serverUs, std::uint64_t receivedUs);
    // A new connection: another server has another clock. Inputs are counted on.
    void reset();
    // ms; nothing for a frame that shows no change, as one of a picture at rest, or whose age no known clock tells.
    // `paintedUs`: our clock.
    std::optional<double> painted(const protocol::FrameHeader& header, std::uint64_t paintedUs);

 private:
    std::optional<std::int64_t> serverAheadUs_;
    std::uint64_t leastRoundTripUs_ = 0;  // of the pong that said so: the quickest errs least
    std::uint32_t newestInput_ = 0;
    std::optional<std::uint32_t> shownRev_;
};

}  // namespace caustream::connection
