#include "client/connection/backoff.h"

#include <algorithm>

namespace caustream::connection {
namespace {

constexpr double kMostMs = 60'000;  // who is told to wait longer asks again in between

}  // namespace

int Backoff::next(double random) {
    const int bound = boundMs_;
    boundMs_ = std::min(2 * boundMs_, kLongestWaitMs);
    return static_cast<int>(bound * (0.5 + 0.5 * random));
}

int comeBackMs(unsigned reconnectMs, unsigned jitterMs, double random) {
    return static_cast<int>(std::min(kMostMs, reconnectMs + random * jitterMs));
}

}  // namespace caustream::connection
