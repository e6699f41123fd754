// Two threads that read scenes, so that a large file holds up no socket and no frame, and one viewer's files not another's:
// who has one being read waits for it, and those that wait take turns. Two, as reading is a core's work and the renderer
// and the encoders want the others.
#pragma once
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

namespace caustream::session {

class LoadPool {
   public:
    using Owner = std::uint64_t;
    // Must not throw, and ends soon once `ended` is true. It is called in any case, be it to say that it has been ended.
    using Task = std::function<void(const std::atomic<bool>& ended)>;

    LoadPool();
    ~LoadPool();  // ends what runs, drops what has not started

    // One owner's are run in order. What it returns, set to true, ends this one.
    std::shared_ptr<std::atomic<bool>> submit(Owner owner, Task task);
    void end(Owner owner);  // all of its tasks

   private:
    struct Pending {
        Task task;
        std::shared_ptr<std::atomic<bool>> ended;
    };
    struct Queue {
        std::deque<Pending> pending;
        std::shared_ptr<std::atomic<bool>> running;  // nothing: none is
    };
    void work();
    std::map<Owner, Queue>::iterator nextTurn();

    std::mutex mutex_;
    std::condition_variable wake_;
    std::map<Owner, Queue> queues_;  // of owners with something to do; guarded by mutex_
    Owner last_ = 0;                 // whose turn was the last; guarded by mutex_
    bool stopping_ = false;          // guarded by mutex_
    std::array<std::thread, 2> threads_;
};

}  // namespace caustream::session
