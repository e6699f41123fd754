// One slot between two threads: a new value replaces one that was not taken.
#pragma once
#include <mutex>
#include <optional>
#include <utility>

namespace caustream::connection {

template <class T>
class Mailbox {
 public:
    void put(T value) {
        std::optional<T> old{std::move(value)};
        {
            std::scoped_lock lock(mutex_);
            old.swap(slot_);
        }
        // `old` is freed here, outside the lock: it may be a large picture.
    }
    std::optional<T> take() {
        std::scoped_lock lock(mutex_);
        return std::exchange(slot_, std::nullopt);
    }

 private:
    std::mutex mutex_;
    std::optional<T> slot_;  // guarded by mutex_
};

}  // namespace caustream::connection
