// How far apart a caster throws the ends of the spectrum: what a gap between two traced wavelengths is measured by.
#pragma once
#include <glm/vec2.hpp>

#include "render/coarse_trace.h"
#include "render/view.h"

namespace caustream::render {

// Means over the flux of 8 x 8 photons, in shares of the map's sides.
struct SpectralSpread {
    glm::vec2 ends{0.0f};      // |violet - red|
    glm::vec2 bend{0.0f};      // of the middle of the spectrum (in 1/lambda^2) from halfway between the two
    float flux = 0.0f;         // of the photons whose three wavelengths all landed
};

SpectralSpread spectralSpread(const CoarseTrace& tracer, const scene::Scene& scene, const scene::Light& light,
                              const scene::Object& caster, const View& emission, const View& map);

// Texels of a map of `size` a side that light between two of `wavelengths` is off by. Exact ones stand for the stretch
// around them; in a continuous spectrum light between them is interpolated, and only the bend is missed.
glm::vec2 spectralStep(const SpectralSpread& spread, int wavelengths, bool continuous, int size);

}  // namespace caustream::render
