#pragma once
#include <span>
#include <string>
#include <string_view>

namespace caustream::session {

std::string hex(std::span<const unsigned char> bytes);  // two lower-case digits each

std::string randomId();  // 128 bits that cannot be guessed, in hex
bool isId(std::string_view text);  // looks like one of those

// What others follow a session by: the same on every server, and no way back from it to the session, which whoever knows
// its id may take over.
std::string viewIdOf(std::string_view session);

}  // namespace caustream::session
