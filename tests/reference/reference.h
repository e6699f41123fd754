// The reference scenes "sphere", "prism" and "gem": their maps, and themselves as GLB.
#pragma once
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/reference/npy.h"

namespace caustream::reference {

struct Window {  // on the floor y = 0; cell (i, j) has its middle at x0 + (i + .5) w / cells, z0 + (j + .5) w / cells
    double x0 = 0, z0 = 0, width = 1;  // m
    int cells = 256;
};

struct Reference {
    nlohmann::json json;  // the file, whole
    Window window;
    std::array<double, 3> lightPosition{};
    double halfAngleDeg = 0;         // hard edge, 1 cd inside
    std::vector<double> nm;          // of the bands of mono7
    std::vector<double> windowFlux;  // of each band, as the tracer summed it
    npy::Array mono7;   // [nm][j][i] irradiance of the caustic alone for 1 W/sr; no direct light
    npy::Array direct;  // [j][i] direct irradiance cos / r^2, 0 in the caster's shadow and outside the cone
    std::optional<npy::Array> xyz;  // [3][j][i] CIE XYZ of a flat spectrum, continuous; the prism alone has it
};

// The JSON file of a scene; it need not exist.
std::string sceneFile(const std::string& name);

// Throws std::runtime_error when a file is missing or damaged.
Reference load(const std::string& name);

// The scene as a GLB: caster (the sphere an icosphere of 20 * 4^sphereLevels faces, so 5,120 by default), a floor that
// reaches far past the window, the spot ("key", 1 cd), a camera above.
std::vector<std::uint8_t> makeGlb(const Reference& reference, int sphereLevels = 4);

}  // namespace caustream::reference
