// How much light a spectral map holds, counted on the CPU.
#pragma once
#include <glm/vec4.hpp>
#include <vector>

#include "gl/names.h"
#include "render/view.h"

namespace caustream::render {

// Four floats a texel, rows bottom to top. Waits for the GPU.
std::vector<glm::vec4> readTexels(const gl::Texture& image);

// The light's flux per unit intensity through texel `index` of size x size: sr, or m^2 in a parallel view.
double texelExtent(const View& view, int size, int index);

// Luminous flux of a map (RGBA32F concentration in linear BT.709) over the light's intensity on its axis.
double mapFlux(const gl::Texture& concentration, const View& view);

}  // namespace caustream::render
