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

// Cut stones on a dark table: a round brilliant of diamond on its side, and an emerald.
std::vector<std::uint8_t> makeBrilliant();
std::vector<std::uint8_t> makeEmerald();

// A glass of water: two bodies that overlap, told apart by their priorities.
std::vector<std::uint8_t> makeWater();

// A gold ring set with a sapphire.
std::vector<std::uint8_t> makeJewel();

// Newton's second prism: of the colours that the first spreads, one passes a slit, and the second bends it as it is.
std::vector<std::uint8_t> makeNewton();

// A ball of glass on a table, the light as high as its focus needs to lie there.
std::vector<std::uint8_t> makeBall();

}  // namespace caustream::scenes
