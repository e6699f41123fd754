#pragma once
#include <string>

namespace caustream::session {

std::string randomId();  // 128 bits that cannot be guessed, in hex

}  // namespace caustream::session
