#include "client/connection/frame_age.h"

#include <algorithm>
#include <utility>

namespace caustream::connection {

void FrameAge::pong(std::uint64_t sentUs, std::uint64_t serverUs, std::uint64_t receivedUs) {
    const std::uint64_t roundTrip = receivedUs - std::min(sentUs, receivedUs);
    if (serverAheadUs_ && roundTrip > leastRoundTripUs_) return;
    leastRoundTripUs_ = roundTrip;
    serverAheadUs_ = static_cast<std::int64_t>(serverUs - (sentUs + roundTrip / 2));
}

void FrameAge::reset() {
    serverAheadUs_.reset();
    shownRev_.reset();
}

std::optional<double> FrameAge::painted(const protocol::FrameHeader& header, std::uint64_t paintedUs) {
    // Only the first frame with an input or a change tells its age: those that follow at rest are later for no fault of
    // their own.
    const bool changed = std::exchange(shownRev_, header.stateRev) != header.stateRev;
    if (header.inputSeq > newestInput_ && header.clientUs != 0) {
        newestInput_ = header.inputSeq;
        return static_cast<double>(paintedUs - std::min(header.clientUs, paintedUs)) / 1000.0;
    }
    if (!serverAheadUs_ || !changed) return std::nullopt;
    const auto underWayUs = static_cast<std::int64_t>(paintedUs - header.serverUs) + *serverAheadUs_;
    const auto onServerUs = std::int64_t{header.holdUs} + header.renderUs + header.encodeUs;
    return static_cast<double>(std::max<std::int64_t>(underWayUs + onServerUs, 0)) / 1000.0;
}

}  // namespace caustream::connection
