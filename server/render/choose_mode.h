// Which transport Mode::Auto stands for.
#pragma once
#include <span>
#include <string>

#include "render/exact_surfaces.h"
#include "render/frame.h"

namespace caustream::render {

struct ModeChoice {
    Mode mode = Mode::Refined;
    std::string why;                       // a sentence; empty: the mode was asked for
    bool traceAtRest = false;              // refined only as long as something moves
};

// Sets of planes are traced exactly at once; meshes while nothing moves (Request::converge); where no caster bends or
// throws light there is nothing to trace.
ModeChoice chooseMode(const Request& request, std::span<const ExactCaster> casters);

}  // namespace caustream::render
