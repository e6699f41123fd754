// The scenes that come with the server, each in its setting.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace caustream::scenes {

// GLB of "sphere", "ring", "gem", "bunny", "glass", "prism", "brilliant", "emerald", "water", "jewel", "newton" or "ball".
// Throws std::runtime_error for another name, and for the bunny when its model is not on this machine.
std::vector<std::uint8_t> makeBuiltin(const std::string& name);

}  // namespace caustream::scenes
