// FRAME payload -> Image. What comes off the wire is checked against the header before memory is taken.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "client/connection/image.h"

namespace caustream::connection {

// One per thread: keeps the JPEG decoder's tables.
class Decoder {
 public:
    Decoder();
    // The error is a sentence; what does not fit the header is refused.
    tl::expected<Image, std::string> decode(const protocol::FrameHeader& header, std::span<const std::uint8_t> payload);

 private:
    std::unique_ptr<void, int (*)(void*)> jpeg_;
};

}  // namespace caustream::connection
