// How far, how fast and to what a scene's map converges.
#pragma once
#include <string>

#include "bench/converge/at_rest.h"

namespace caustream::bench {

struct SceneReport {
    std::string scene;
    // At 512^2 and the defaults, against the same transport with many more photons
    double secondsToGood = 0, errorThere = 0;    // until the error stays under `good`; 0: never
    double secondsToEnd = 0, errorAtEnd = 0, estimateAtEnd = 0;
    int frames = 0;
    std::uint64_t photons = 0;
    double framesPerSecond = 0;
    bool converged = false;
    // The map at the end against the reference tracer, on cells of 4 x 4 of its texels or more
    double truth = 0, truthNoise = 0, flux = 0, ledgerGap = 0, cut = 0;
    std::string where;
    std::vector<render::StageTime> stages;       // of a frame at rest

    bool fast() const { return secondsToGood > 0.0 && secondsToGood <= 3.0 && framesPerSecond >= 10.0; }
};

struct ReportSettings {
    int pictureSize = 512, cells = 256;
    int map = 512, bounces = 8;
    bool exactReceivers = false;
    double good = 0.02;
    double mostSeconds = 60.0;                   // of frames at rest
    double referencePhotons = 8.0;               // times those at the end, for the own reference
    std::uint64_t tracerPhotons = 1u << 23;
    std::string cacheFolder;
};

SceneReport reportScene(Renderer& renderer, const std::string& scene, const ReportSettings& settings);

}  // namespace caustream::bench
