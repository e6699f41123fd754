// What waits for one connection's socket, in the order it must leave: texts first, then frames, each behind the
// stream.info of its epoch; a frame that was asked for also behind its statistics and the reply. Numbers frames as they
// leave, keeps the acknowledgement window and tells the rate controller. Network thread only.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "protocol/messages.h"
#include "stream/frame_mailbox.h"
#include "stream/rate_controller.h"
#include "stream/wire_buffer.h"

namespace caustream::session {

struct Outgoing {
    stream::WireBuffer buffer;
    bool binary = false;
};

// A frame ready to leave. The outbox fills header.frameSeq, header.epoch, header.serverUs and info.epoch.
struct OutgoingFrame {
    stream::WireBuffer buffer;  // kFrameHeaderBytes free, then the payload
    protocol::FrameHeader header;
    protocol::StreamInfo info;
    protocol::Stats stats;                    // frameSeq and the window's numbers are filled by the outbox
    bool resting = false;                     // drawn because nothing moved
    double pictureMs = 0.0;                   // of drawing and encoding, what depends on the picture's size
    std::uint64_t changedUs = 0, encodedUs = 0;  // server's clock: what it shows; when it was ready
    std::optional<std::uint32_t> requestId;   // of the frame.request that it answers
    std::string mapHash;                      // for that answer
};

class Outbox {
   public:
    void setMaxInflight(std::uint32_t frames) { rate_.setMaxInflight(frames); }
    void setFrameRate(double fps) { rate_.setFrameRate(fps); }

    void text(std::string message) { texts_.push_back(std::move(message)); }
    void streamed(std::uint64_t order, OutgoingFrame frame) { mailbox_.put(order, std::move(frame)); }
    void requested(OutgoingFrame frame) { requested_.push_back(std::move(frame)); }

    // What was drawn at rest and waits shows what is no more; a frame of a moving picture is still worth its time.
    void discardResting();
    void countOutdated() { ++outdated_; }  // such a frame that came too late to wait here

    // Cumulative. False when `ack` names a frame that was not sent: nothing changes then.
    bool acknowledge(const protocol::Ack& ack, std::uint64_t nowUs);

    // The next message, if the window lets one leave.
    std::optional<Outgoing> next(std::uint64_t nowUs);

    // Frames of the stream that left and were not acknowledged. What frame.request asked for stands outside the window.
    std::uint32_t unacknowledged() const { return static_cast<std::uint32_t>(waiting_.size()); }
    std::uint32_t window() const { return rate_.window(); }
    int level() const { return rate_.level(); }  // of the quality ladder, for the next frame

    // Frames that frame.request asked for and the socket has not taken.
    std::size_t answersWaiting() const { return requested_.size() + (staged_ && staged_->requestId ? 1 : 0); }

    // The unacknowledged and those that wait for the socket to take them.
    std::uint32_t occupied() const {
        const bool stagedStream = staged_ && !staged_->requestId;
        return unacknowledged() + (mailbox_.peek() ? 1u : 0u) + (stagedStream ? 1u : 0u);
    }

    // When the oldest of them left.
    std::optional<std::uint64_t> waitingSinceUs() const;

    std::size_t textBytes() const;
    protocol::Drops drops() const { return {static_cast<std::uint32_t>(mailbox_.replaced()), outdated_}; }
    std::uint32_t dropped() const { return drops().replaced + drops().outdated; }
    std::uint32_t sent() const { return sent_; }
    std::uint64_t sentBytes() const { return sentBytes_; }
    double ageMs() const { return ageMs_; }  // of the newest acknowledged frame of a moving picture, from the change it shows; 0: unknown

    // Of the newest frame that left, with this connection's numbers; nothing before the first and once it was taken.
    std::optional<protocol::Stats> takeStats();
    const std::optional<protocol::Stats>& newestStats() const { return stats_; }
    // That frame ended its state's convergence.
    bool newestConverged() const { return newestConverged_; }

   private:
    struct Sent {
        std::uint32_t seq;
        std::uint64_t changedUs;  // 0: of a picture at rest, which is of no age
        stream::RateController::Sent frame;
    };
    bool mayLeave(const OutgoingFrame& frame) const;
    void stage(OutgoingFrame frame);
    protocol::Stats withConnection(protocol::Stats stats) const;

    std::deque<std::string> texts_;
    stream::FrameMailbox<OutgoingFrame> mailbox_;
    std::deque<OutgoingFrame> requested_;
    std::optional<OutgoingFrame> staged_;  // leaves once texts_ is empty: its stream.info and reply stand there
    std::optional<protocol::StreamInfo> info_;
    std::optional<protocol::Stats> stats_;
    bool newestConverged_ = false;
    std::deque<Sent> waiting_;  // frames of the stream only
    stream::RateController rate_;
    std::uint32_t sent_ = 0, outdated_ = 0;
    std::uint64_t sentBytes_ = 0;
    double ageMs_ = 0.0;
};

}  // namespace caustream::session
