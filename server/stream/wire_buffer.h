// Bytes of one message with free room in front, so that a header and the socket library's framing go before the payload
// without a copy. Left uninitialised: a worst-case JPEG buffer costs only the pages that are written.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

namespace caustream::stream {

inline constexpr std::size_t kSocketHeadroom = 32;  // at least LWS_PRE; checked where the socket is

class WireBuffer {
   public:
    WireBuffer() = default;
    explicit WireBuffer(std::size_t capacity)
        : storage_(std::make_unique_for_overwrite<std::uint8_t[]>(kSocketHeadroom + capacity)), size_(capacity) {}
    explicit WireBuffer(std::string_view text) : WireBuffer(text.size()) { text.copy(reinterpret_cast<char*>(data()), text.size()); }

    std::uint8_t* data() { return storage_ ? storage_.get() + kSocketHeadroom : nullptr; }
    std::size_t size() const { return size_; }
    void shrink(std::size_t size) { size_ = size < size_ ? size : size_; }
    std::span<std::uint8_t> bytes() { return {data(), size_}; }

   private:
    std::unique_ptr<std::uint8_t[]> storage_;
    std::size_t size_ = 0;
};

}  // namespace caustream::stream
