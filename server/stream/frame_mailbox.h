// One slot, newest wins: what a slow connection has not taken yet is replaced, never queued.
// Owned by the network thread; frames of one session may arrive out of order when several threads encode.
#pragma once
#include <cstdint>
#include <optional>
#include <utility>

namespace caustream::stream {

template <typename T>
class FrameMailbox {
   public:
    // False when something newer was already taken or waits; `order` rises with every frame rendered.
    bool put(std::uint64_t order, T value) {
        if (order <= newest_) {
            ++replaced_;
            return false;
        }
        newest_ = order;
        replaced_ += slot_.has_value();
        slot_ = std::move(value);
        return true;
    }

    std::optional<T> take() { return std::exchange(slot_, std::nullopt); }

    // Discards what waits. False when nothing did.
    bool clear() {
        const bool had = slot_.has_value();
        slot_.reset();
        return had;
    }

    const std::optional<T>& peek() const { return slot_; }
    std::uint64_t replaced() const { return replaced_; }  // values that a newer one took the place of

   private:
    std::optional<T> slot_;
    std::uint64_t newest_ = 0, replaced_ = 0;
};

}  // namespace caustream::stream
