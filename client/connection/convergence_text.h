// A picture's way to convergence, in words that every viewer uses.
#pragma once
#include <cstdint>
#include <string>

#include "protocol/server_messages.h"

namespace caustream::connection {

// "8,214", "412 thousand", "1.2 million", "3.4 billion".
std::string countText(std::uint64_t count);

// "1.2 million photons, error about 2.3%": how far it has come.
std::string convergenceText(const protocol::Convergence& convergence);

}  // namespace caustream::connection
