#include "stream/rate_controller.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace caustream::stream {
namespace {

// Of the gaps between acknowledgements the lower quartile is taken: where a window is too small for the distance, every
// other gap is a wait for the server's next frame; the shortest may be two acknowledgements that travelled together.
constexpr std::size_t kPairs = 8;
constexpr double kSameFrame = 0.25;     // of a frame's time: less than that over a whole number of frames is noise
constexpr double kClimbMs = 0.8 * RateController::kTooLateMs;  // what the better level is to stay below

double ratio(int level, int before) { return Ladder::at(level).testBytes / Ladder::at(before).testBytes; }

double areaRatio(int level, int before) {
    const double side = Ladder::at(level).scale / Ladder::at(before).scale;
    return side * side;
}

}  // namespace

RateController::Sent RateController::sent(std::uint64_t nowUs, std::size_t bytes, int level, double pictureMs,
                                          std::uint32_t unacknowledged) {
    frameBytes_ = static_cast<double>(bytes);
    const bool measures = probing_;  // and waits for nothing: its being early says nothing of the level
    if (unacknowledged == 0) {
        probing_ = false;
        lastAloneUs_ = nowUs;
    }
    return {nowUs, bytes, measures ? Ladder::kFixed : level, pictureMs, unacknowledged == 0};
}

void RateController::acknowledged(const Sent& newest, std::size_t bytes, std::uint64_t nowUs) {
    rttMs_ = static_cast<double>(nowUs - newest.atUs) * 1e-3;
    learnRate(newest, bytes, nowUs);
    learnPropagation(newest, nowUs);
    lastAckUs_ = nowUs;
    if (newest.level == level_ && ++ofLevel_ >= window()) {
        step(newest, nowUs);
    }
}

void RateController::learnRate(const Sent& newest, std::size_t bytes, std::uint64_t nowUs) {
    if (newest.atUs > lastAckUs_ || lastAckUs_ == 0) {
        return;  // the link had nothing to do in between
    }
    const bool first = perByte_.empty();
    perByte_.push_back(static_cast<double>(nowUs - lastAckUs_) / static_cast<double>(std::max<std::size_t>(bytes, 1)));
    if (perByte_.size() > kPairs) {
        perByte_.pop_front();
    }
    if (first) {  // what travelled alone before said this much more than was known then
        for (Alone& frame : alone_) {
            frame.propagationUs = std::max(0.0, frame.rttUs - perByteUs() * static_cast<double>(frame.bytes));
        }
    }
}

void RateController::learnPropagation(const Sent& newest, std::uint64_t nowUs) {
    if (newest.alone) {
        const double rttUs = static_cast<double>(nowUs - newest.atUs);
        alone_.push_back({nowUs, rttUs, std::max(0.0, rttUs - perByteUs() * static_cast<double>(newest.bytes)), newest.bytes});
    }
    while (alone_.size() > 1 && nowUs - alone_.front().atUs > kBaseUs) {
        alone_.pop_front();
    }
    // A longer memory than this many says nothing more of the least.
    if (alone_.size() > 256) {
        const auto most = std::ranges::max_element(alone_, {}, &Alone::rttUs);
        alone_.erase(most);
    }
    probing_ = probing_ || nowUs - lastAloneUs_ > kProbeUs;
}

double RateController::perByteUs() const {
    if (perByte_.empty()) {
        return 0.0;
    }
    std::vector<double> sorted(perByte_.begin(), perByte_.end());
    const auto quartile = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 4);
    std::ranges::nth_element(sorted, quartile);
    return *quartile;
}

double RateController::propagationUs() const {
    return alone_.empty() ? 0.0 : std::ranges::min(alone_, {}, &Alone::propagationUs).propagationUs;
}

double RateController::baseRttMs() const {
    return alone_.empty() ? 0.0 : std::ranges::min(alone_, {}, &Alone::rttUs).rttUs * 1e-3;
}

std::uint32_t RateController::window() const {
    if (probing_ || mostInflight_ <= 1) {
        return 1;
    }
    std::uint32_t frames = kLeastWindow;
    if (const double perByte = perByteUs(); perByte > 0.0) {
        const double betweenUs = std::max(1e6 / fps_, perByte * frameBytes_);
        const double inPipe = (propagationUs() + perByte * frameBytes_) / betweenUs;
        frames = static_cast<std::uint32_t>(1.0 + std::clamp<double>(std::ceil(inPipe - kSameFrame), 1.0, kMostWindow));
    }
    return std::min({frames, kMostWindow, mostInflight_});
}

double RateController::waitedMs(const Sent& newest) const {
    const double known = perByte_.empty() ? baseRttMs() * 1e3 : propagationUs() + perByteUs() * static_cast<double>(newest.bytes);
    return std::max(0.0, rttMs_ - known * 1e-3);
}

double RateController::lateMs(const Sent& newest, int level) const {
    return waitedMs(newest) * ratio(level, newest.level) +
           std::max(0.0, newest.pictureMs * areaRatio(level, newest.level) - kBudgetMs);
}

void RateController::moveTo(int level, std::uint64_t nowUs) {
    level_ = level;
    ofLevel_ = 0;
    steppedUs_ = nowUs;
}

void RateController::step(const Sent& newest, std::uint64_t nowUs) {
    const std::uint64_t sinceUs = nowUs - steppedUs_;
    const bool tooLate = lateMs(newest, level_) > kTooLateMs;
    if (tooLate && level_ < Ladder::kWorst && sinceUs >= kStepDownUs) {
        holdUs_ = climbed_ ? std::min(2 * holdUs_, kMostHoldUs) : holdUs_;
        climbed_ = false;
        int level = level_ + 1;
        while (level < Ladder::kWorst && lateMs(newest, level) > kTooLateMs) {
            ++level;
        }
        moveTo(level, nowUs);
    } else if (!tooLate && level_ > Ladder::kBest && sinceUs >= holdUs_ && lateMs(newest, level_ - 1) < kClimbMs) {
        holdUs_ = climbed_ ? kHoldUs : holdUs_;  // the climb before this one held
        climbed_ = true;
        moveTo(level_ - 1, nowUs);
    } else if (climbed_ && sinceUs >= holdUs_) {
        climbed_ = false;
        holdUs_ = kHoldUs;
    }
}

}  // namespace caustream::stream
