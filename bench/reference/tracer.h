// An exact light tracer on the CPU, to measure the renderer against: double precision, every interface with Snell,
// unpolarised Fresnel and Beer-Lambert, both branches followed. Slow and simple; it shares no transport code with server/
// or shaders/.
#pragma once
#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "bench/reference/world.h"

namespace caustream::tracer {

// A rectangle in space that collects what lands on receivers within `toleranceM` of its plane, from either side.
struct Window {
    glm::dvec3 origin{0.0};              // corner of cell (0, 0)
    glm::dvec3 u{1, 0, 0}, v{0, 0, 1};   // whole edges, m, at right angles: columns run along u, rows along v
    int columns = 256, rows = 256;
    double toleranceM = 1e-5;
};

// The renderer's spectral map: collects what lands on receivers that the light sees.
struct MapView {
    glm::dmat4 worldToClip{1.0};         // render::Frame::lightMatrix: an unsheared view from the light
    int size = 512;                      // texels a side; row 0 at clip y = -1
};

enum class Observer {
    Wyman2013,   // the fit of the shared reference maps
    Cie1931      // the table of optics/colour.h, what the renderer uses
};

struct Settings {
    std::vector<double> wavelengthsNm;   // traced exactly; may be empty
    int continuousSamples = 0;           // wavelengths a photon, one in each equal part of 380-680 nm; 0: no XYZ
    Observer observer = Observer::Cie1931;
    std::uint64_t photons = 1u << 20;    // directions in all, half of them in each of two independent halves
    int maxInterfaces = 32;              // of one path, 1..256; what would meet another is booked as interfaceLimit
    double minWeight = 1e-4;             // of a photon's own: a weaker branch is booked as belowThreshold
    bool firstReflection = false;        // follow what glass throws back that the light meets first, too
    int threads = 2;                     // 1 or 2; the result is the same bits
    std::vector<Window> windows;
    std::vector<MapView> maps;
};

struct Image {
    int columns = 0, rows = 0, channels = 0;
    std::vector<float> values;               // [channel][row][column]
    std::vector<double> relativeL1;          // estimated error of each channel: sum |a - b| / sum (a + b) of the halves
    float at(int channel, int row, int column) const {
        return values[(static_cast<std::size_t>(channel) * static_cast<std::size_t>(rows) + static_cast<std::size_t>(row)) *
                          static_cast<std::size_t>(columns) +
                      static_cast<std::size_t>(column)];
    }
};

// Windows: irradiance of the caustic alone for unit intensity (1 W/sr gives W m^-2; directional: 1 W m^-2 gives W m^-2).
// Maps: concentration, 1 = as bright as direct light. Light straight from the lamp is in neither.
struct Collected {
    Image bands;                             // one channel a wavelength of Settings::wavelengthsNm
    Image xyz;                               // CIE XYZ of the light's spectrum, over the Y of its direct light: equal energy
                                             //   everywhere gives Y = 1. xyzToRgb() of optics/colour.h makes it linear BT.709
};

// Flux in units of the light's flux per steradian on its axis (sr; m^2 for a directional light).
struct Ledger {                              // mirrors: what metal took
    double onCasters = 0;                    // all of the following
    double landed = 0, absorbed = 0, mirrors = 0, firstReflected = 0, belowThreshold = 0, interfaceLimit = 0, escaped = 0;
};

struct Result {
    std::vector<Collected> windows, maps;    // as in Settings
    std::vector<Ledger> ledgers;             // one a wavelength
    Ledger continuous;                       // mean over the spectrum's wavelengths
    std::vector<double> hidden;              // one a map: flux inside its bounds but on receivers the light does not see,
                                             //   mean of the wavelengths (of the spectrum when there are none)
    double worstClosure = 0;                 // of any photon: |onCasters - sum of the rest| / onCasters
    double extent = 0;                       // of all directions sampled, sr or m^2
    std::uint64_t photons = 0, hits = 0;     // sampled; of these met a caster first
    double seconds = 0;                      // of the trace itself, also when it came from a cache
    bool cached = false;
};

// Called now and then on the calling thread, with what is done of the whole, 0..1.
using Progress = std::function<void(double)>;

// Same input, same bits. Throws Error when Embree does not start, std::invalid_argument for settings out of range.
Result trace(const World& world, const Settings& settings, const Progress& progress = {});

// The same through a folder of earlier results, which is made when it is not there. A file is found by a SHA-256 of all
// that its result depends on, and used only if its own checksum is right; new ones are renamed into place.
Result traceCached(const std::string& folder, const World& world, const Settings& settings, const Progress& progress = {});

// relative L1 = sum |a - b| / sum b over the cells of a channel, and what goes with it. Two dark maps are equal; against
// one dark map the ratios are not finite.
struct Difference {
    double relativeL1 = 0, fluxRatio = 0;    // sum a / sum b
    double centroidCells = 0;                // between the centroids
    double worst = 0;                        // largest |a - b| over the mean of b
};
Difference difference(const float* a, const float* b, int columns, int rows);

}  // namespace caustream::tracer
