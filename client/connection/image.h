// A decoded picture or map, whatever way it came, and what to make of it: floats, or eight bits to look at.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "protocol/frame_header.h"

namespace caustream::connection {

struct Image {
    int width = 0, height = 0, bands = 0;            // bands: 3 for colour, or one per wavelength
    protocol::Sample sample = protocol::Sample::U8;  // U8: sRGB; F16 and F32: linear
    float scale = 1.0f;                              // value = sample * scale, F16 and F32 only
    std::vector<std::uint8_t> data;                  // interleaved, rows top to bottom, native byte order

    std::size_t samples() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(bands);
    }
};

// IEEE 754 binary16 to binary32, exact.
float halfToFloat(std::uint16_t half);

// Every sample as a float, interleaved: U8 / 255, still sRGB; F16 and F32 linear, scale applied.
std::vector<float> toFloats(const Image& image);

// What maps linear values to a picture: the `fraction` quantile of each texel's largest band becomes white. 1 when the
// image is dark throughout. Not finite values are left out.
float whiteLevel(const std::vector<float>& linear, int bands, double fraction = 0.995);

// Three bands of sRGB bytes. Linear images are divided by `white` (<= 0: their whiteLevel) and clipped; one band is
// shown as grey, and of many bands the thirds are averaged, last (longest wavelengths) to red.
Image toPicture(const Image& image, float white = 0.0f);

}  // namespace caustream::connection
