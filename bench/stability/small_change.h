// How much a spectral map differs from that of a light a hair's breadth away.
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace caustream::stability {

struct MapImage {
    int size = 0;                        // texels a side; 0: no map
    std::vector<glm::vec4> texels;       // concentration, layer value of the receiver
    glm::mat4 worldToClip{1.0f};
};

constexpr float kLightStep = 1e-5f;      // of the light's distance from the casters, or radians for a directional light
constexpr int kCellTexels = 16;          // half width of the tents that average

// Light number `index` turned about the casters' middle, its aim with it. Nothing where floats are too coarse for such a
// step: far from the origin.
std::optional<scene::Scene> withLightMoved(scene::Scene scene, int index);

// L1 distance of the two maps' flux, averaged by tents of kCellTexels around each kCellTexels-th texel, over the flux of
// `a`; both are looked up where a's texels lie in the world. 0 when both are dark, 1 when one is.
double changeBetween(const MapImage& a, const MapImage& b);

}  // namespace caustream::stability
