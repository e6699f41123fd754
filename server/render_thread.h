// The thread with the GL context: asks the scheduler, runs the pipeline, hands frames to the encoders.
#pragma once
#include <atomic>
#include <condition_variable>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "config.h"
#include "scheduler.h"
#include "session/outbox.h"
#include "stream/encode_pool.h"
#include "test_frames.h"

namespace caustream {

struct Delivery {
    FrameJob job;
    session::OutgoingFrame frame;
    std::string error;  // a sentence; the frame is empty then
};

class RenderThread {
   public:
    // `deliver` is called on an encoder thread, or on this one for a frame that failed. Must not throw.
    // Returns once every shader is compiled; throws what went wrong with the GPU.
    RenderThread(const Config& config, std::function<void(Delivery&&)> deliver);
    ~RenderThread();

    // Calls change(scheduler) under the lock and lets the render thread look again. Any thread.
    template <typename Change>
    auto schedule(Change&& change) {
        const Notify notify{wake_};
        const std::lock_guard lock(mutex_);
        return change(scheduler_);
    }

    // What the renderer made for scenes that no one shows is dropped before its next frame. Any thread.
    void collect();

    const std::string& gpuName() const { return gpuName_; }
    std::uint64_t busySinceUs() const { return busySinceUs_; }  // 0: idle
    const char* lost() const { return lost_; }                  // why nothing can be drawn any more; nullptr: it can
    std::uint64_t frames() const { return frames_; }
    std::uint64_t failures() const { return failures_; }
    std::uint64_t lightRuns() const { return lightRuns_; }      // frames whose light was worked out
    std::uint64_t lightReuses() const { return lightReuses_; }  // and those that found it done

   private:
    struct Gpu;
    struct Notify {  // after the lock is released, so that the woken thread finds it free
        std::condition_variable& wake;
        ~Notify() { wake.notify_one(); }
    };
    void work(std::promise<void>& warm);
    void serve(Gpu& gpu);
    void reloadShaders(Gpu& gpu);  // with mutex_ held
    void draw(Gpu& gpu, FrameJob job);
    void failOnPurpose() const;
    void notice(Gpu& gpu, bool outOfMemory);
    void finish(const FrameJob& job, const render::Frame& frame);

    Config config_;
    std::function<void(Delivery&&)> deliver_;
    std::string gpuName_;  // written before the constructor returns

    std::mutex mutex_;
    std::condition_variable wake_;
    Scheduler scheduler_;     // guarded by mutex_
    bool stopping_ = false;   // guarded by mutex_
    bool collecting_ = false; // guarded by mutex_

    std::atomic<std::uint64_t> busySinceUs_{0}, frames_{0}, failures_{0}, lightRuns_{0}, lightReuses_{0};
    std::atomic<const char*> lost_{nullptr};
    int outOfMemory_ = 0;  // frames in a row, anyone's; render thread

    // Render thread: the newest still of each session that gets it once more, without loss.
    struct Still {
        std::shared_ptr<const View> view;
        render::Frame frame;
    };
    std::map<SessionKey, Still> stills_;
    TestFrames testFrames_;

    stream::EncodePool encoders_;
    std::thread thread_;
};

}  // namespace caustream
