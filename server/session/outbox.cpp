#include "session/outbox.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace caustream::session {
namespace {

bool sameEpoch(protocol::StreamInfo a, const protocol::StreamInfo& b) {
    a.epoch = b.epoch;
    if (a.target != protocol::Target::Spectral) {
        a.lightMatrix = b.lightMatrix;  // only who reads the map needs to know where it lies
    }
    return a == b;
}

}  // namespace

void Outbox::discardResting() {
    if (const auto& waiting = mailbox_.peek(); waiting && waiting->resting) {
        outdated_ += mailbox_.clear();
    }
}

bool Outbox::acknowledge(const protocol::Ack& ack, std::uint64_t nowUs) {
    if (ack.seq > sent_) {
        return false;
    }
    std::optional<Sent> newest;
    std::size_t bytes = 0;
    while (!waiting_.empty() && waiting_.front().seq <= ack.seq) {
        newest = waiting_.front();
        bytes += newest->frame.bytes;
        waiting_.pop_front();
    }
    if (newest) {
        rate_.acknowledged(newest->frame, bytes, nowUs);
        ageMs_ = newest->changedUs ? static_cast<double>(nowUs - newest->changedUs) * 1e-3 : ageMs_;
    }
    return true;
}

// Frames at rest leave the window's last place to what moves next, unless it is the only one.
bool Outbox::mayLeave(const OutgoingFrame& frame) const {
    return unacknowledged() < (frame.resting && window() > 1 ? window() - 1 : window());
}

void Outbox::stage(OutgoingFrame frame) {
    frame.header.frameSeq = ++sent_;
    if (!info_ || !sameEpoch(frame.info, *info_)) {
        frame.info.epoch = static_cast<std::uint16_t>(info_ ? info_->epoch + 1 : 1);
        info_ = frame.info;
        text(protocol::encode(frame.info));
    }
    frame.header.epoch = info_->epoch;
    if (frame.requestId) {
        frame.stats.frameSeq = frame.header.frameSeq;
        text(protocol::encode(withConnection(frame.stats)));
        protocol::Ok reply{.id = *frame.requestId};
        reply.frame = protocol::FrameReply{frame.header.frameSeq, frame.mapHash};
        text(protocol::encode(reply));
    }
    staged_ = std::move(frame);
}

std::optional<Outgoing> Outbox::next(std::uint64_t nowUs) {
    if (texts_.empty() && !staged_) {
        if (!requested_.empty()) {
            stage(std::move(requested_.front()));
            requested_.pop_front();
        } else if (mailbox_.peek() && mayLeave(*mailbox_.peek())) {
            stage(*mailbox_.take());
        }
    }
    if (!texts_.empty()) {
        Outgoing outgoing{stream::WireBuffer(texts_.front()), false};
        texts_.pop_front();
        return outgoing;
    }
    if (!staged_) {
        return std::nullopt;
    }
    OutgoingFrame frame = std::move(*staged_);
    staged_.reset();
    frame.header.serverUs = nowUs;
    std::ranges::copy(protocol::encodeHeader(frame.header), frame.buffer.data());
    if (!frame.requestId) {
        const int level = frame.resting ? stream::Ladder::kFixed : frame.header.level;
        waiting_.push_back({frame.header.frameSeq, frame.resting ? 0 : frame.changedUs,
                            rate_.sent(nowUs, frame.buffer.size(), level, frame.pictureMs, unacknowledged())});
    }
    frame.stats.sendMs = static_cast<double>(nowUs - std::min(nowUs, frame.encodedUs)) * 1e-3;
    sentBytes_ += frame.buffer.size();
    frame.stats.frameSeq = frame.header.frameSeq;
    stats_ = std::move(frame.stats);
    newestConverged_ = (frame.header.flags & protocol::kFrameConverged) != 0;
    return Outgoing{std::move(frame.buffer), true};
}

std::optional<std::uint64_t> Outbox::waitingSinceUs() const {
    return waiting_.empty() ? std::nullopt : std::optional(waiting_.front().frame.atUs);
}

std::size_t Outbox::textBytes() const {
    return std::accumulate(texts_.begin(), texts_.end(), std::size_t{0},
                           [](std::size_t sum, const std::string& message) { return sum + message.size(); });
}

std::optional<protocol::Stats> Outbox::takeStats() {
    std::optional<protocol::Stats> stats = std::exchange(stats_, std::nullopt);
    return stats ? std::optional(withConnection(std::move(*stats))) : std::nullopt;
}

protocol::Stats Outbox::withConnection(protocol::Stats stats) const {
    stats.window = window();
    stats.drops = drops();
    stats.dropped = dropped();
    stats.rttMs = rate_.rttMs();
    stats.baseRttMs = rate_.baseRttMs();
    stats.ageMs = ageMs_;
    return stats;
}

}  // namespace caustream::session
