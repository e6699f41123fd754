// A procedural wooden surface.
#pragma once
#include <cstdint>
#include <vector>

namespace caustream::scenes {

// PNG, sRGB: planks along x, `width` x `height` texels.
std::vector<std::uint8_t> woodPng(int width, int height);

}  // namespace caustream::scenes
