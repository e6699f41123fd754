// One thread that reads scenes, so that a large file holds up no socket and no frame.
#pragma once
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace caustream::session {

class LoadThread {
   public:
    LoadThread();
    ~LoadThread();  // drops what has not started, waits for what has

    void submit(std::function<void()> task);  // must not throw

   private:
    void work();

    std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<std::function<void()>> tasks_;  // guarded by mutex_
    bool stopping_ = false;                    // guarded by mutex_
    std::thread thread_;
};

}  // namespace caustream::session
