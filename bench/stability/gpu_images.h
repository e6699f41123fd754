// Every picture that the passes keep on the GPU, whichever they are: read back from the GL context itself, so that a pass
// that joins tomorrow is looked at too.
#pragma once
#include <cstdint>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

namespace caustream::stability {

// A texture that holds floats (layers, depths, maps, pictures): normalised formats cannot hold NaN and are left out.
struct GpuImage {
    unsigned name = 0;
    std::string label;
    int width = 0, height = 0;
    bool depth = false;
    std::uint64_t hash = 0;               // FNV-1a of its bits, all levels
    std::size_t notFinite = 0;            // NaN or infinite values
    bool operator==(const GpuImage&) const = default;
};

// Of the current context, in the order of their making.
std::vector<GpuImage> readGpuImages();

// RGBA of one of them.
std::vector<glm::vec4> readTexels(const GpuImage& image);

// Errors that GL keeps, as their numbers; and forgets.
std::vector<unsigned> takeGlErrors();

}  // namespace caustream::stability
