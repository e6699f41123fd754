// What the frames of a scene run and leave out, in words, without a viewer.
#pragma once
#include <string>

#include "config.h"

namespace caustream {

// Draws three small steps of config.planScene with config.settings (a first frame, one after a camera move, one after a
// move of all lights) and tells the plan of each. Throws Error: no such scene, a file that does not load, a setting that
// makes no sense, no GPU.
std::string planReport(const Config& config);

}  // namespace caustream
