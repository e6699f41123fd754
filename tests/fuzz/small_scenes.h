// GLB files of a few kilobytes that between them use all that the loader knows.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace caustream::fuzz {

// By name: the built-in scenes with a few triangles for each mesh and a texel for each picture, and files made by hand,
// right ones and hostile ones.
std::map<std::string, std::vector<std::uint8_t>> smallScenes();

}  // namespace caustream::fuzz
