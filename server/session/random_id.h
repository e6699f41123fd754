#pragma once
#include <span>
#include <string>

namespace caustream::session {

std::string hex(std::span<const unsigned char> bytes);  // two lower-case digits each

std::string randomId();  // 128 bits that cannot be guessed, in hex

}  // namespace caustream::session
