// How different two colours look.
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace caustream::bench {

// CIE L*a*b* under D65 of an sRGB pixel.
glm::dvec3 labOfSrgb(std::uint8_t r, std::uint8_t g, std::uint8_t b);

// CIEDE2000 with kL = kC = kH = 1. Sharma, Wu & Dalal 2005, "The CIEDE2000 Color-Difference Formula", Eqs. 2-22; the
// arguments are L*a*b*. About 1 is just visible side by side.
double ciede2000(const glm::dvec3& lab1, const glm::dvec3& lab2);

struct PictureDifference {
    double mean = 0, p99 = 0;   // over the pixels
};
// Of two sRGB pictures of one size, 3 bytes a pixel.
PictureDifference pictureDifference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b);

}  // namespace caustream::bench
