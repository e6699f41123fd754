// A few threads that turn rendered frames into wire buffers, so that the render thread never waits for a codec.
#pragma once
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "stream/encoder.h"

namespace caustream::stream {

struct Encoded {
    WireBuffer buffer;
    double encodeMs = 0.0;
    std::string error;  // a sentence; empty when the buffer is good
};

class EncodePool {
   public:
    // Called on a pool thread with the frame given back (its pixels are spent) and the outcome. Must not throw.
    using Done = std::function<void(render::Frame&&, Encoded&&)>;

    explicit EncodePool(int threads);
    ~EncodePool();  // drops what has not started, waits for what has

    void submit(render::Frame&& frame, const EncodeSettings& settings, Done done);

   private:
    struct Job {
        render::Frame frame;
        EncodeSettings settings;
        Done done;
    };
    void work();

    std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<Job> jobs_;     // guarded by mutex_; bounded by the sessions' acknowledgement windows
    bool stopping_ = false;    // guarded by mutex_
    std::vector<std::thread> threads_;
};

}  // namespace caustream::stream
