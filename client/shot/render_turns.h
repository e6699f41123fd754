// Whose turn it is to have frames drawn, so that a batch comes to the same bits over however many connections.
#pragma once
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace caustream::shot {

// A map that converges keeps its photons, and what else shows the same light gets them, too. So stills of single frames come
// first, and lines that converge after them, one by one, in the order of the batch.
class RenderTurns {
 public:
    RenderTurns(std::size_t stills, const std::atomic<bool>& stop) : stills_(stills), stop_(stop) {}

    // Waits for the turn, or for `stop`. `order`: which of the lines that converge this is, from 0.
    void enterStill();
    void enterConverging(std::size_t order);
    void leaveStill();
    void leaveConverging();

 private:
    template <class Ready>
    void waitUntil(std::unique_lock<std::mutex>& lock, const Ready& ready);

    std::mutex mutex_;
    std::condition_variable changed_;
    std::size_t stills_;               // not done. guarded by mutex_, like the next two
    std::size_t drawing_ = 0;          // stills
    std::size_t converged_ = 0;
    const std::atomic<bool>& stop_;
};

}  // namespace caustream::shot
