// What a frame's header and the statistics say, in words that every viewer uses.
#pragma once
#include <string>

#include "protocol/server_messages.h"

namespace caustream::connection {

// "level 3, JPEG 60", "fixed, JPEG 90", "without loss".
std::string qualityText(const protocol::FrameHeader& header);

// "512 x 384"; "256 x 192, shown at 512 x 384" of a scaled picture.
std::string sizeText(const protocol::FrameHeader& header);

// "none"; "3 replaced, 1 outdated".
std::string dropsText(const protocol::Drops& drops);

}  // namespace caustream::connection
