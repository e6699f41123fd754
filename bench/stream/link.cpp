#include "bench/stream/link.h"

#include <algorithm>
#include <cassert>

namespace caustream::bench {
namespace {

constexpr double kPacket = 1448;         // bytes of a full Ethernet segment: less is not worth a wake-up
constexpr double kBurstS = 0.010;        // what a thread that wakes late may catch up with
constexpr std::size_t kQueue = 64u << 10;  // beyond what is under way: the small queue in front of any link
constexpr std::size_t kUnlimited = 256u << 10;

}  // namespace

double Link::burst() const { return std::max(2 * kPacket, shape_.bytesPerS * kBurstS); }

void Link::earn(std::uint64_t nowUs) {
    if (lastUs_ != 0) tokens_ = std::min(burst(), tokens_ + shape_.bytesPerS * 1e-6 * static_cast<double>(nowUs - lastUs_));
    lastUs_ = nowUs;
}

void Link::reshape(LinkShape shape, std::uint64_t nowUs) {
    earn(nowUs);
    shape_ = shape;
    tokens_ = std::min(tokens_, burst());
}

bool Link::full() const {
    const double underWay = shape_.bytesPerS * 1e-6 * static_cast<double>(shape_.delayUs);
    return held_ >= (shape_.bytesPerS > 0 ? static_cast<std::size_t>(underWay) + kQueue : kUnlimited);
}

std::size_t Link::room(std::uint64_t nowUs) {
    earn(nowUs);
    if (full()) return 0;
    if (shape_.bytesPerS <= 0) return kUnlimited - held_;
    return tokens_ < kPacket ? 0 : static_cast<std::size_t>(tokens_);
}

void Link::enter(std::string_view bytes, std::uint64_t nowUs) {
    if (bytes.empty()) return;
    tokens_ -= shape_.bytesPerS > 0 ? static_cast<double>(bytes.size()) : 0.0;
    held_ += bytes.size();
    passed_ += bytes.size();
    // A path that became shorter does not let the younger bytes overtake.
    const std::uint64_t before = pieces_.empty() ? 0 : pieces_.back().arrivesUs;
    pieces_.push_back({std::string(bytes), std::max(before, nowUs + shape_.delayUs)});
}

std::string_view Link::arrived(std::uint64_t nowUs) const {
    if (pieces_.empty() || pieces_.front().arrivesUs > nowUs) return {};
    return std::string_view(pieces_.front().bytes).substr(taken_);
}

void Link::leave(std::size_t bytes) {
    assert(!pieces_.empty() && taken_ + bytes <= pieces_.front().bytes.size());
    held_ -= bytes;
    taken_ += bytes;
    if (taken_ == pieces_.front().bytes.size()) {
        pieces_.pop_front();
        taken_ = 0;
    }
}

std::uint64_t Link::nextUs(std::uint64_t nowUs) {
    earn(nowUs);
    std::uint64_t next = 0;
    if (!pieces_.empty() && pieces_.front().arrivesUs > nowUs) next = pieces_.front().arrivesUs;
    if (shape_.bytesPerS > 0 && tokens_ < kPacket && !full()) {
        const auto earned = nowUs + static_cast<std::uint64_t>((kPacket - tokens_) / shape_.bytesPerS * 1e6) + 1;
        next = next == 0 ? earned : std::min(next, earned);
    }
    return next;
}

}  // namespace caustream::bench
