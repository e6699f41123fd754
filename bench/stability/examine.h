// One case in one mode, rendered in every way a client could ask for, and what was wrong with it.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/stability/case.h"
#include "gl/context.h"
#include "gl/shader_library.h"

namespace caustream::stability {

struct Mode {
    std::string name;
    render::Mode transport = render::Mode::Refined;
    int wavelengths = 7;                  // or render::kContinuous
    bool mustPass = true;                 // false: a baseline whose failures are listed
};
std::span<const Mode> modes();

// One renderer for all cases: programs are compiled once, everything else is made anew for each.
struct Renderer {
    explicit Renderer(const std::string& gpu) : context(gl::Context::create({.gpu = gpu})) {}
    std::unique_ptr<gl::Context> context;
    gl::ShaderLibrary shaders;
};

struct Failure {
    std::string check;                    // finite, ledger, bits, GL, change, energy, converge, error
    std::string what;                     // a sentence's rest
};

constexpr double kLedgerLimit = 1e-4;     // of the flux on casters: what fixed point rounds away
// Of the map's flux, averaged by tents of 16 texels (small_change.h): all of it moved by half a texel along each axis, as
// much as the grids of two maps can differ; a tent of half width s changes by 2 h / s for a step of h along an axis.
constexpr double kChangeLimit = 0.125;

struct Outcome {
    std::vector<Failure> failures;
    double ledgerGap = 0.0;               // the worst of all frames
    render::EnergyLedger ledger;
    double change = 0.0;                  // of the map, for a small change of the light
    std::string jumps;                    // why this case's map may change at will; empty: it must not
    std::optional<render::Residuals> residuals;
    std::uint32_t photons = 0;
    std::vector<std::string> warnings;    // what the renderer says of the scene
    double ms = 0.0;
};

// `frames` of a round trip. Failures of the environment (no GPU memory) are failures of the case.
Outcome examine(Renderer& renderer, const Case& which, const Mode& mode, int frames);

}  // namespace caustream::stability
