// How wrong a spectral map is, told from what its passes book beside it. Nothing here needs a second map.
#pragma once
#include "render/frame.h"

namespace caustream::render {

// Measures of one map, each a share of the luminous flux in it.
struct MapDifferences {
    double halves = 0.0;        // sum over texels of |even - odd|, the luminance of the two halves of the photons
    double roughness = 0.0;     // sum over the pyramid's coarser levels and their texels of |texel - mean of its neighbours|
    double grain = 0.0;         // the same of the finest level, along its rows
    double spectralStep = 0.0;  // what it would change by, were each wavelength spread over the stretch it stands for
};

// Relative L1 of luminance, 0..2. Two maps of equal energy differ by no more than 2.
ErrorEstimate estimateError(const MapDifferences& map);

}  // namespace caustream::render
