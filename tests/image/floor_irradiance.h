// A streamed spectral map seen as irradiance on the window of a reference scene, and how far the two are apart.
#pragma once
#include <vector>

#include "render/frame.h"
#include "tests/reference/reference.h"

namespace caustream::image {

// [band][j][i] irradiance per unit of intensity on the window's cells: each the mean over `samples` x `samples` points of
// the concentration there times cos / r^2 of the light.
std::vector<float> floorIrradiance(const render::Frame& frame, const reference::Reference& reference, int samples);

struct Comparison {
    double relativeL1 = 0;         // sum |a - b| / sum b, mean of the wavelengths
    double fluxRatio = 0;          // sum a / sum b, mean of the wavelengths
    double worstFluxRatio = 1;     // the one farthest from 1
    double worstCentroidCells = 0; // displacement of the centroid, the farthest of the wavelengths
};
Comparison compare(const std::vector<float>& irradiance, const reference::Reference& reference);

}  // namespace caustream::image
