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

std::vector<GLuint> readWords(const gl::Buffer& buffer, std::size_t count);

// FNV-1a, word by word; begin with kFnvStart.
std::uint64_t fnv1a(std::uint64_t hash, const std::vector<GLuint>& words);
inline constexpr std::uint64_t kFnvStart = 0xcbf29ce484222325ull;

}  // namespace caustream::render
