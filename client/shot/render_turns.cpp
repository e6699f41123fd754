#include "client/shot/render_turns.h"

#include <chrono>

namespace caustream::shot {
namespace {

// A server keeps the light of four poses and more; a line needs two where it asks for bands, too.
constexpr std::size_t kStillsAtOnce = 2;

}  // namespace

template <class Ready>
void RenderTurns::waitUntil(std::unique_lock<std::mutex>& lock, const Ready& ready) {
    while (!ready() && !stop_) changed_.wait_for(lock, std::chrono::milliseconds(200));  // a signal handler wakes no one
}

void RenderTurns::enterStill() {
    std::unique_lock lock(mutex_);
    waitUntil(lock, [this] { return drawing_ < kStillsAtOnce; });
    ++drawing_;
}

void RenderTurns::leaveStill() {
    {
        const std::scoped_lock lock(mutex_);
        --drawing_;
        --stills_;
    }
    changed_.notify_all();
}

void RenderTurns::enterConverging(std::size_t order) {
    std::unique_lock lock(mutex_);
    waitUntil(lock, [&] { return stills_ == 0 && converged_ == order; });
}

void RenderTurns::leaveConverging() {
    {
        const std::scoped_lock lock(mutex_);
        ++converged_;
    }
    changed_.notify_all();
}

}  // namespace caustream::shot
