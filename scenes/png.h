// Pictures for textures.
#pragma once
#include <cstdint>
#include <vector>

namespace caustream::scenes {

// PNG of 8-bit sRGB texels, three bytes each, rows top to bottom. Throws std::runtime_error.
std::vector<std::uint8_t> encodePng(int width, int height, const std::vector<std::uint8_t>& rgb);

}  // namespace caustream::scenes
