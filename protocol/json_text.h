// Text from outside -> JSON value. Refuses what nlohmann::json lets pass: duplicate keys and bottomless nesting.
#pragma once
#include <cstddef>
#include <string_view>
#include <tl/expected.hpp>

#include "protocol/state.h"

namespace caustream::protocol {

// Errors: too_large for the length; bad_message for syntax, UTF-8, numbers beyond a double, depth and duplicates.
tl::expected<Json, DecodeError> parseText(std::string_view text, std::size_t maxBytes, std::size_t maxDepth);

}  // namespace caustream::protocol
