// GPU image -> Frame's pixels.
#pragma once
#include "gl/names.h"
#include "render/frame.h"

namespace caustream::render {

// RGB of `image` as U8, F16 or F32, its rows in their order; a texture without a name gives zeros of the frame's size.
void readImage(const gl::Texture& image, Sample sample, Frame& frame);

// A picture of 8 bits with the byte that nobody needs, as the driver has it.
void readRgbx(const gl::Texture& image, Frame& frame);

// What PlanarYuv made of a picture of this size; after a barrier for buffer updates.
void readPlanes(const gl::Buffer& planes, PixelLayout layout, int width, int height, Frame& frame);

// Concentration [texel][band] as F16 or F32.
void packBands(const std::vector<float>& values, int size, int bands, Sample sample, Frame& frame);

}  // namespace caustream::render
