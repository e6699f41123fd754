// A viewer at rest: a frame after the light moved, then frames that converge, each a whole picture.
#pragma once
#include <cstdint>
#include <vector>

#include "bench/accuracy/clock.h"
#include "bench/accuracy/renderer.h"
#include "bench/accuracy/subject.h"
#include "bench/accuracy/window.h"

namespace caustream::bench {

struct RestSettings {
    int pictureSize = 512;
    int cells = 256;                     // a side, of what maps are compared on
    int mostFrames = 2000;
    double mostSeconds = 120.0;          // of frames
    bool pictures = true;                // false: the map alone, for a reference
    std::uint64_t mostPhotons = ~std::uint64_t{0};
};

// The map after so many frames.
struct RestPoint {
    int frames = 0;
    Spent spent;                         // of the frames; what looking at the map takes does not count
    std::uint64_t photons = 0;
    double estimate = 0;                 // relative L1 that the renderer expects
    std::vector<float> luminance;        // of the window's cells
};

struct AtRest {
    std::vector<RestPoint> points;       // ever rarer; the last is the end
    Window window;                       // the subject's plane, or the view of its map
    double worstLedgerGap = 0;           // of all frames
    render::EnergyLedger ledger;         // in the end
    bool converged = false;
    std::vector<render::StageTime> stages;   // of a frame at rest, medians, longest first
};

// From a light pose that the pipeline has not seen; its programs are compiled and its images made before the clock starts.
AtRest comeToRest(Renderer& renderer, const Subject& subject, const Configuration& configuration, const RestSettings& settings);

double relativeL1(const std::vector<float>& map, const float* reference);

}  // namespace caustream::bench
