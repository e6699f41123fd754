#include "stream/encode_pool.h"

#include <chrono>
#include <exception>
#include <utility>

namespace caustream::stream {

EncodePool::EncodePool(int threads) {
    for (int i = 0; i < threads; ++i) {
        threads_.emplace_back([this] { work(); });
    }
}

EncodePool::~EncodePool() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        jobs_.clear();
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) {
        thread.join();
    }
}

void EncodePool::submit(render::Frame&& frame, const EncodeSettings& settings, Done done) {
    {
        const std::lock_guard lock(mutex_);
        jobs_.push_back({std::move(frame), settings, std::move(done)});
    }
    wake_.notify_one();
}

void EncodePool::work() {
    Encoder encoder;
    std::unique_lock lock(mutex_);
    while (true) {
        wake_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
        if (stopping_) {
            return;
        }
        Job job = std::move(jobs_.front());
        jobs_.pop_front();
        lock.unlock();
        Encoded encoded;
        const auto start = std::chrono::steady_clock::now();
        try {
            encoded.buffer = encoder.encode(job.frame, job.settings);
        } catch (const std::exception& problem) {
            encoded.error = problem.what();
        }
        encoded.encodeMs = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        job.done(std::move(job.frame), std::move(encoded));
        lock.lock();
    }
}

}  // namespace caustream::stream
