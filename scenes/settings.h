// One function per embedded scene: a GLB of the caster in its setting.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace caustream::scenes {

// In the Cornell box.
std::vector<std::uint8_t> makeSphere();
std::vector<std::uint8_t> makeRing();
std::vector<std::uint8_t> makeGem();
// `objPath`: a Wavefront file of triangles. Throws std::runtime_error when it cannot be read.
std::vector<std::uint8_t> makeBunny(const std::string& objPath);

// A full glass on a wooden table.
std::vector<std::uint8_t> makeGlass();

// A flint prism in a dark room that throws a wide rainbow on a white floor.
std::vector<std::uint8_t> makePrism();

}  // namespace caustream::scenes
