// How many frames of one connection may be on their way, and how good the next one is. It knows what was handed to the
// socket and when the viewer said it had shown it; clocks are the caller's. Network thread only.
//
// The link is taken to be a pipe that passes one frame after another: a frame takes its propagation plus its bytes times
// the link's time per byte, behind those that were sent before it. The time per byte is seen between the acknowledgements
// of two frames that were on their way together, the sum on a frame that travelled alone; every ten seconds one is made to
// (Cardwell et al. 2016, BBR: bandwidth and propagation cannot be seen at once). What a frame waits beyond both is the
// delay that the ladder keeps down.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>

#include "stream/ladder.h"

namespace caustream::stream {

class RateController {
   public:
    static constexpr std::uint32_t kLeastWindow = 2, kMostWindow = 6;  // one on the screen, the others on their way
    static constexpr double kBudgetMs = 33.0;      // that a frame may wait, and that its picture may take to draw
    static constexpr double kTooLateMs = 1.5 * kBudgetMs;
    static constexpr std::uint64_t kBaseUs = 30'000'000;    // propagation is the least of so long
    static constexpr std::uint64_t kProbeUs = 10'000'000;   // a frame travels alone at least so often
    static constexpr std::uint64_t kStepDownUs = 100'000;   // between two steps down
    static constexpr std::uint64_t kHoldUs = 700'000, kMostHoldUs = 4'000'000;  // before a step up; doubled when one fails

    struct Sent {
        std::uint64_t atUs = 0;
        std::size_t bytes = 0;
        int level = Ladder::kFixed;  // kFixed: of a frame that does not follow the ladder; it tells of the link alone
        double pictureMs = 0.0;      // what drawing and encoding its pixels took: less at a smaller size
        bool alone = false;          // nothing else was on its way
    };

    void setMaxInflight(std::uint32_t frames) { mostInflight_ = frames; }
    void setFrameRate(double fps) { fps_ = fps; }

    // A frame leaves; `unacknowledged` others are on their way.
    Sent sent(std::uint64_t nowUs, std::size_t bytes, int level, double pictureMs, std::uint32_t unacknowledged);

    // `newest` was acknowledged, together with older ones; all of them had `bytes`.
    void acknowledged(const Sent& newest, std::size_t bytes, std::uint64_t nowUs);

    // Frames that may be on their way: those that fill the pipe at the link's or the stream's frame rate, and one more.
    std::uint32_t window() const;
    int level() const { return level_; }

    double rttMs() const { return rttMs_; }          // of the newest acknowledged frame; 0: unknown
    double baseRttMs() const;                        // the least of kBaseUs; 0: unknown

   private:
    struct Alone {
        std::uint64_t atUs;
        double rttUs, propagationUs;
        std::size_t bytes;
    };
    void learnRate(const Sent& newest, std::size_t bytes, std::uint64_t nowUs);
    void learnPropagation(const Sent& newest, std::uint64_t nowUs);
    double perByteUs() const;                        // 0: unknown
    double propagationUs() const;
    double waitedMs(const Sent& newest) const;
    double lateMs(const Sent& newest, int level) const;  // as it would be at `level`
    void step(const Sent& newest, std::uint64_t nowUs);
    void moveTo(int level, std::uint64_t nowUs);

    std::uint32_t mostInflight_ = kLeastWindow;
    double fps_ = 60.0;

    std::deque<double> perByte_;                     // us, of the newest pairs
    std::deque<Alone> alone_;
    std::uint64_t lastAckUs_ = 0, lastAloneUs_ = 0;
    double frameBytes_ = 0.0;                        // of the newest frame
    bool probing_ = false;
    double rttMs_ = 0.0;

    int level_ = Ladder::kBest;
    std::uint32_t ofLevel_ = 0;                      // frames of this level acknowledged: the first waited for larger ones
    std::uint64_t steppedUs_ = 0, holdUs_ = kHoldUs;
    bool climbed_ = false;                           // the last step, and it has not yet proved itself
};

}  // namespace caustream::stream
