// So many events a second, with a burst of one second's worth.
#pragma once
#include <algorithm>
#include <cstdint>

namespace caustream::session {

class TokenBucket {
   public:
    explicit TokenBucket(double perS) : perS_(perS), tokens_(perS) {}

    // False when there were too many; `nowUs` never runs backwards.
    bool take(std::uint64_t nowUs) {
        if (lastUs_ != 0) {
            tokens_ = std::min(perS_, tokens_ + perS_ * static_cast<double>(nowUs - lastUs_) * 1e-6);
        }
        lastUs_ = nowUs;
        if (tokens_ < 1.0) {
            return false;
        }
        tokens_ -= 1.0;
        return true;
    }

    // One event was no more than the answer to what we sent: it does not count.
    void giveBack() { tokens_ = std::min(perS_, tokens_ + 1.0); }

   private:
    double perS_, tokens_;
    std::uint64_t lastUs_ = 0;
};

}  // namespace caustream::session
