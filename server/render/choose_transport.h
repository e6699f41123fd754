// Which photon grid, map size, wavelengths and steps meet a budget or a target error: from what frames cost on this
// machine and how wrong their maps were. Plain numbers in and out: no clock, no GL.
#pragma once
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/frame.h"

namespace caustream::render {

// A transport that can be chosen, with what it is expected to cost and to miss.
struct Configuration {
    int photonGrid = 0, mapSize = 0;
    int wavelengths = 1;               // as Transport's
    int backSteps = 4;
    double ms = 0.0;                   // of a frame after the light moved
    double error = 0.0;                // relative L1, with what its texels blur
    bool sameAs(const Configuration& other) const;
};

struct Choice {
    Configuration configuration;
    bool met = true;                   // the budget, the target
    std::string sentence;              // what was chosen and why, for FrameStats::choice
};

// The configurations that no other beats in both: from the cheapest to the most accurate.
std::vector<Configuration> paretoFront(std::vector<Configuration> configurations);

// The best of `front` (not empty) for the budget or the target of `wanted`; the nearest where none meets it. `previous`
// is kept while it is nearly as good, so that a moving light does not flicker between two of them.
Choice choose(std::span<const Configuration> front, const Transport& wanted, const std::optional<Configuration>& previous = {});

// Medians of the newest few measurements: one slow frame does not change them.
class Recent {
   public:
    void add(double value);
    std::size_t size() const { return values_.size(); }
    double medianOr(double fallback) const;

   private:
    std::deque<double> values_;
};

// What frames took on this machine, in the parts that scale differently, and how wrong the maps of one scene were. Fed by
// every frame; what was not seen yet is guessed from what was, or from typical values.
class Calibration {
   public:
    // `light`: the light's side ran. `transport`: as it ran, its grid resolved. `photons`: of FrameStats.
    void learnCost(const Transport& transport, const FrameStats& stats, bool light);
    // Of the scene that is identified by `scene`; forgets the others' after a while.
    void learnError(const void* scene, const Transport& transport, const ErrorEstimate& error, std::uint32_t photons);

    // What of the wish stays as it is.
    struct Kept {
        bool wavelengths = false, mapSize = false;
    };
    // All that can be chosen, with cost and error as expected for `scene`; one wavelength alone when no glass disperses.
    std::vector<Configuration> configurations(const void* scene, const Transport& wanted, bool dispersive, Kept kept) const;

   private:
    struct SceneError {
        const void* scene = nullptr;
        ErrorEstimate error;
        double photons = 0.0;
        int photonGrid = 0, mapSize = 0;
        double exponent = 0.0;         // of photons a texel
        // Spectral error of one exact wavelength, of which more have a share, and of a continuous spectrum.
        std::optional<double> oneWavelength, continuous;
    };
    double photonNs(int wavelengths) const;
    Configuration expected(Configuration configuration, const SceneError& known) const;

    Recent fixedMs_, restMs_, texelNs_;
    std::map<int, Recent> photonNs_;   // by wavelengths
    std::deque<SceneError> scenes_;    // newest first
};

}  // namespace caustream::render
