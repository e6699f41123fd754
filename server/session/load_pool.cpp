#include "session/load_pool.h"

#include <utility>

namespace caustream::session {

LoadPool::LoadPool() {
    for (std::thread& thread : threads_) {
        thread = std::thread([this] { work(); });
    }
}

LoadPool::~LoadPool() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        for (auto& [owner, queue] : queues_) {
            queue.pending.clear();
            if (queue.running) {
                *queue.running = true;
            }
        }
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) {
        thread.join();
    }
}

std::shared_ptr<std::atomic<bool>> LoadPool::submit(Owner owner, Task task) {
    auto ended = std::make_shared<std::atomic<bool>>(false);
    {
        const std::lock_guard lock(mutex_);
        queues_[owner].pending.push_back({std::move(task), ended});
    }
    wake_.notify_one();
    return ended;
}

void LoadPool::end(Owner owner) {
    const std::lock_guard lock(mutex_);
    const auto found = queues_.find(owner);
    if (found == queues_.end()) {
        return;
    }
    for (const Pending& pending : found->second.pending) {
        *pending.ended = true;
    }
    if (found->second.running) {
        *found->second.running = true;
    }
}

// The first owner after the last one that waits and has nothing being read.
std::map<LoadPool::Owner, LoadPool::Queue>::iterator LoadPool::nextTurn() {
    auto turn = queues_.upper_bound(last_);
    for (std::size_t left = queues_.size(); left > 0; --left, ++turn) {
        if (turn == queues_.end()) {
            turn = queues_.begin();
        }
        if (!turn->second.running && !turn->second.pending.empty()) {
            return turn;
        }
    }
    return queues_.end();
}

void LoadPool::work() {
    std::unique_lock lock(mutex_);
    while (!stopping_) {
        const auto turn = nextTurn();
        if (turn == queues_.end()) {
            wake_.wait(lock);
            continue;
        }
        const Owner owner = last_ = turn->first;
        const Pending next = std::move(turn->second.pending.front());
        turn->second.pending.pop_front();
        turn->second.running = next.ended;
        lock.unlock();
        next.task(*next.ended);
        lock.lock();
        const auto done = queues_.find(owner);
        done->second.running.reset();
        if (done->second.pending.empty()) {
            queues_.erase(done);
        } else {
            wake_.notify_one();  // the other thread may have found nothing but this owner's
        }
    }
}

}  // namespace caustream::session
