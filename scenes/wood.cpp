#include "scenes/wood.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "scenes/png.h"

namespace caustream::scenes {

namespace {

constexpr int kPlanks = 5;

// A number in 0..1 for each lattice point (Wang's integer hash).
double lattice(int x, int y, int seed) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8DA6B343u ^ static_cast<std::uint32_t>(y) * 0xD8163841u ^
                      static_cast<std::uint32_t>(seed) * 0xCB1AB31Fu;
    h = (h ^ 61u) ^ (h >> 16);
    h *= 9u;
    h ^= h >> 4;
    h *= 0x27D4EB2Du;
    h ^= h >> 15;
    return h / 4294967295.0;
}

// Value noise, smooth between lattice points.
double noise(double x, double y, int seed) {
    const double fx = std::floor(x), fy = std::floor(y);
    const int ix = static_cast<int>(fx), iy = static_cast<int>(fy);
    const auto fade = [](double t) { return t * t * (3.0 - 2.0 * t); };
    const double u = fade(x - fx), v = fade(y - fy);
    return std::lerp(std::lerp(lattice(ix, iy, seed), lattice(ix + 1, iy, seed), u),
                     std::lerp(lattice(ix, iy + 1, seed), lattice(ix + 1, iy + 1, seed), u), v);
}

// u, v in 0..1; sRGB 0..1.
glm::dvec3 woodAt(double u, double v) {
    const int plank = std::min(static_cast<int>(v * kPlanks), kPlanks - 1);
    const double across = v * kPlanks - plank;
    // Growth rings: a far larger circle than the plank, cut lengthways and bent by slow noise.
    const double bend = noise(u * 2.5, plank * 7.3 + across * 1.5, plank) * 5.0;
    const double ring = 0.5 + 0.5 * std::sin(2.0 * std::numbers::pi * (across * 3.0 + bend));
    const double fibre = noise(u * 18.0, v * 420.0, 11), pore = noise(u * 60.0, v * 700.0, 23);
    const double tone = 0.55 * ring + 0.25 * fibre + 0.2 * lattice(plank, 3, 5);
    glm::dvec3 color = glm::mix(glm::dvec3(0.42, 0.25, 0.13), glm::dvec3(0.66, 0.45, 0.27), tone);
    color *= 1.0 - 0.25 * glm::smoothstep(0.80, 0.95, pore);
    const double seam = std::min(across, 1.0 - across);
    return color * (0.45 + 0.55 * glm::smoothstep(0.0, 0.012, seam));
}

}  // namespace

std::vector<std::uint8_t> woodPng(int width, int height) {
    std::vector<std::uint8_t> texels;
    texels.reserve(static_cast<std::size_t>(width) * height * 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::dvec3 color = woodAt((x + 0.5) / width, (y + 0.5) / height);
            for (int c = 0; c < 3; ++c)
                texels.push_back(static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(color[c], 0.0, 1.0))));
        }
    return encodePng(width, height, texels);
}

}  // namespace caustream::scenes
