// When to say how far reading has come: not at once, as most files are read before anyone wonders, and then not often.
#pragma once
#include <cstdint>

namespace caustream::session {

class LoadProgress {
   public:
    static constexpr std::uint64_t kEveryUs = 250'000;

    explicit LoadProgress(std::uint64_t nowUs) : lastUs_(nowUs) {}

    // True if it is time to say so.
    bool due(std::uint64_t nowUs) {
        if (nowUs - lastUs_ < kEveryUs) {
            return false;
        }
        lastUs_ = nowUs;
        return true;
    }

   private:
    std::uint64_t lastUs_;
};

}  // namespace caustream::session
