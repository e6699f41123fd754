// What the renderer is asked for and what it gives back. Values only; no GL types.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "optics/colour.h"
#include "render/omission.h"
#include "scene/scene.h"

namespace caustream::render {

// Thesis: as published (Blanchette 2012), the baseline of comparisons. Traced: every interface and bounce exactly,
// converging while nothing moves. Auto: of refined and traced, what suits the scene and whether anything moves.
enum class Mode { Refined, Thesis, Traced, Auto };

constexpr int kContinuous = 0;              // of Transport::wavelengths
constexpr int kContinuousBands = 7;         // exact wavelengths of a map in bands that asks for it

struct Transport {
    Mode mode = Mode::Refined;
    int wavelengths = kContinuous;          // or 1..64 exact ones; ignored when wavelengthsNm is given
    std::vector<double> wavelengthsNm;      // exact wavelengths, ascending, instead of the uniform ones
    int photonGrid = 0;                     // photons per side of each caster's emission view; 0: chosen for the GPU
    int mapSize = 512;                      // texels per side of the spectral map
    int backLayer = 0;                      // texels per side of the casters' back layers; 0: chosen for the photon grid
    int backSteps = 4;                      // Newton steps to the exit point, 1..16
    int receiverSteps = 6;                  // bracketed secant steps to the receiver, 1..32
    bool gapFill = false;                   // the thesis's gap filling
    bool filter = true;                     // smooth the map where photons are sparse
    bool forceDispersive = false;           // trace all wavelengths even where the glass does not disperse
    int hierarchyLevels = 3;                // Thesis: levels of the photon hierarchy, 1..6
    int bounces = 8;                        // Traced: reflections inside that are followed, 0..32
    bool exactReceivers = false;            // Traced: receivers are met triangle by triangle, not in the map's view
    double budgetMs = 0.0;                  // choose the configuration of least error that takes no longer; 0: as given
    double targetError = 0.0;               // choose the fastest whose map is this accurate (relative L1); 0: as given.
                                            //   Traced: where convergence ends; 0: at 1%
    bool operator==(const Transport&) const = default;
};

enum class Target { Composite, Spectral, Pass };
enum class Sample { U8, F16, F32 };

// How the samples of a picture of three bands and 8 bits lie in memory. Everything else is interleaved.
enum class PixelLayout {
    Rgb,       // three bytes a pixel
    Rgbx,      // four; the last one says nothing. As images are read back: for encoders that step over it
    Yuv444,    // planes of Y, Cb and Cr (JPEG's: BT.601, full range), see planesOf()
    Yuv420,    // the same, Cb and Cr of 2x2 pixels each; an odd picture's last column and row are there twice
};

constexpr bool isPlanar(PixelLayout layout) { return layout == PixelLayout::Yuv444 || layout == PixelLayout::Yuv420; }

// Where the planes of a planar picture lie, in bytes. Rows are padded to whole words, as shaders write them.
struct Planes {
    struct Plane {
        int width = 0, height = 0, stride = 0;
        std::size_t offset = 0;
    };
    std::array<Plane, 3> planes;            // Y, Cb, Cr
    std::size_t bytes = 0;                  // of all
};

constexpr Planes planesOf(PixelLayout layout, int width, int height) {
    Planes all;
    const int half = layout == PixelLayout::Yuv420 ? 2 : 1;
    for (std::size_t i = 0; i < all.planes.size(); ++i) {
        const int divide = i == 0 ? 1 : half;
        Planes::Plane& plane = all.planes[i];
        plane.width = (width + half - 1) / half * half / divide, plane.height = (height + half - 1) / half * half / divide;
        plane.stride = (plane.width + 3) / 4 * 4;
        plane.offset = all.bytes;
        all.bytes += static_cast<std::size_t>(plane.stride) * static_cast<std::size_t>(plane.height);
    }
    return all;
}

struct Request {
    std::shared_ptr<const scene::Scene> scene;  // with the session's lights and materials in place of the file's
    scene::Camera camera;
    std::optional<float> exposureEv;        // nothing: automatic
    Transport transport;
    Target target = Target::Composite;
    std::string pass;                       // Target::Pass: a name of passNames()
    Sample sample = Sample::U8;             // U8 for pictures; F16 or F32 for the spectral map; F32 pictures are linear
    PixelLayout pixels = PixelLayout::Rgb;  // of U8 pictures
    bool outerMap = false;                  // Spectral: what landed around the inner map, instead of that
    bool wavelengthBands = false;           // Spectral: one band per wavelength instead of RGB
    optics::Observer observer = optics::Observer::Cie1931;   // the fit: to compare with references made with it
    int width = 512, height = 512;          // of the picture; the spectral map has transport.mapSize a side
    std::uint64_t viewer = 0;               // whose picture it is: what adds up at rest is kept for each
    bool still = false;                     // 4x anti-aliasing, ledger always counted
    bool converge = false;                  // nothing moves: adds photons to this light pose's map, samples to the picture
    bool countResiduals = false;            // traces anew and fills FrameStats::residuals
    Omissions forced;                       // done although the scene does not need them: for measuring and for tests
    // Shown in place of the spectral map that is traced, to measure what the map's error does to a picture: RGB
    // concentration, transport.mapSize a side, in the view of the map that it replaces.
    std::shared_ptr<const std::vector<float>> spectralMap;
};

struct PlanEntry {
    std::string pass;
    bool run = false;
    std::string reason;                     // why it runs or why it need not
    std::vector<std::string> without;       // of a pass that runs: parts of it that are not needed, and why
};

struct StageTime {
    std::string pass;
    double ms = 0.0;                        // GPU timestamps on hardware, wall clock around a finish on software
};

// Flux in units of the light's flux per steradian on its axis (sr; m^2 for a directional light), luminance-weighted.
struct EnergyLedger {
    double onCasters = 0, deposited = 0, absorbed = 0, reflected = 0, totalReflection = 0, rejected = 0, leftMap = 0,
           noReceiver = 0,
           cut = 0;                         // Traced: paths with more bounces than asked for, or too weak to follow
};

// How wrong the spectral map may be: relative L1, of luminance.
struct ErrorEstimate {
    double sampling = 0.0;                  // too few photons: from two interleaved halves of them
    double spectral = 0.0;                  // too few wavelengths
    double total = 0.0;                     // of both
    double resolution = 0.0;                // what texels this wide blur: not an error of the texels, not part of total
};

// How many searches ended how near to what they looked for, by what their last step still changed over what may remain:
// below 1e-6, six decades up to 1 (settled so far), 1 to 10, more.
struct Residuals {
    using Histogram = std::array<std::uint32_t, 9>;
    Histogram exit{};                       // exit points searched from nothing
    Histogram exitFollowed{};               // exit points one step from a neighbour's
    Histogram receiver{};                   // meetings with a receiver
};

// How far a traced map has come. There for every map that is traced or would be if nothing moved.
struct Convergence {
    std::uint64_t photons = 0;              // in the map so far
    double error = 1.0, target = 0.01;      // estimated relative L1 of the map; where it ends
    double progress = 0.0;                  // share of the photons it will take, 0..1
    bool converged = false;                 // more frames of the same state would not differ by more than the target
};

struct FrameStats {
    std::vector<StageTime> stages;
    std::vector<PlanEntry> plan;
    EnergyLedger ledger;
    std::optional<ErrorEstimate> error;     // nothing: no map, or one whose transport cannot tell
    std::optional<Convergence> convergence;
    std::optional<Residuals> residuals;     // when asked for and photons were traced
    std::string choice;                     // what budgetMs or targetError chose, and why; empty: not asked
    std::uint32_t photons = 0;              // traced for the map that this frame shows, times no wavelengths
    double renderMs = 0.0;
    bool lightReused = false;               // the light's side was there: it is as for a frame before, whoever's that was
    double exposureEv = 0.0;                // the one used
    std::vector<std::string> warnings;
};

struct Frame {
    int width = 0, height = 0, bands = 3;
    Sample sample = Sample::U8;
    PixelLayout layout = PixelLayout::Rgb;
    std::vector<std::uint8_t> pixels;       // as `layout` says, rows top to bottom; sRGB for U8, linear otherwise
    std::vector<double> wavelengthsNm;      // traced
    glm::mat4 lightMatrix{1.0f};            // world -> map clip space (x, y in -1..1, row 0 at y = -1)
    std::uint64_t mapHash = 0;              // of the fixed-point map, filled for stills
    FrameStats stats;
};

}  // namespace caustream::render
