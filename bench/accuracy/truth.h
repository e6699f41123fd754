// What a subject's caustic really is, from the reference tracer, and how far a configuration's map is from it.
#pragma once
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/accuracy/renderer.h"
#include "bench/accuracy/subject.h"
#include "bench/accuracy/window.h"
#include "bench/reference/tracer.h"

namespace caustream::bench {

struct TruthSettings {
    std::uint64_t photons = 1u << 21;   // for the spectrum; a quarter of them for the bands
    int cells = 256;               // a side, of windows that are a view
    int pictureSize = 512;
    std::string cacheFolder;
};

struct Truth {
    Window window;
    tracer::Image bands;           // at bandsNm(), in the window's values
    tracer::Image xyz;             // of the continuous spectrum
    double exposureEv = 0;         // of every picture
    std::vector<std::uint8_t> picture;   // with the reference's light in place of the traced map; sRGB
    double seconds = 0;            // of the trace
    bool cached = false;

    // Estimated relative L1 of the reference itself: luminance, and the mean of the bands.
    double luminanceNoise() const { return xyz.relativeL1[1]; }
    double bandsNoise() const;
};

// The continuous spectrum where `window` lies, from the tracer or its cache: windows[0] of a plane, maps[0] of a view.
tracer::Result traceSpectrum(const Subject& subject, const Window& window, std::uint64_t photons, const std::string& cacheFolder,
                             const std::function<void(double)>& progress);
// A traced image in the window's values: planes are irradiance as they are, views are weighed as resample() does.
tracer::Image weighed(tracer::Image image, const Window& window);

Truth makeTruth(Renderer& renderer, const Subject& subject, const TruthSettings& settings, const std::function<void(double)>& progress);

struct MapError {
    double luminance = 0;          // relative L1 of CIE Y against the continuous spectrum
    double colour = 0;             // the same of X, Y and Z together
    double fluxRatio = 0;          // of Y
    double worst = 0;              // of Y: largest difference in a cell, over the reference's mean
    double bands = 0;              // relative L1 at bandsNm(), mean; these wavelengths traced exactly
    std::vector<double> bandFluxRatio, bandCentroid;   // of each; centroids' displacement in shares of the window's width
    double picture = 0, pictureP99 = 0;   // CIEDE2000 of the picture, mean and 99th percentile of the pixels
    std::uint32_t photons = 0;
    double estimate = -1;          // what the frame's statistics estimate for `luminance`; < 0: nothing
};
void to_json(nlohmann::json& json, const MapError& error);
void from_json(const nlohmann::json& json, MapError& error);

MapError measureError(Renderer& renderer, const Subject& subject, const Truth& truth, const Configuration& configuration,
                      const TruthSettings& settings);

}  // namespace caustream::bench
