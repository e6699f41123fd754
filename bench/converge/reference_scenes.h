// Traced beside refined transport on the scenes of tests/reference: photon grid and map 1024, 8 bounces.
#pragma once
#include <string>
#include <vector>

#include "bench/accuracy/renderer.h"

namespace caustream::bench {

struct ReferenceRow {
    std::string scene, mode;
    double relativeL1 = 0, flux = 0, worstFlux = 1, centroidCells = 0;   // means and worst of the seven wavelengths
};
std::vector<ReferenceRow> compareReferences(Renderer& renderer);
std::string referenceTable(const std::vector<ReferenceRow>& rows);
std::string referenceClaims(const std::vector<ReferenceRow>& rows);

}  // namespace caustream::bench
