// A case as one would see it, for looking at what the checks cannot judge.
#pragma once
#include <string>

#include "bench/stability/examine.h"

namespace caustream::stability {

// The still picture with automatic exposure, 256 pixels a side, as a binary PPM. Throws Error when it cannot be written.
void writePicture(Renderer& renderer, const Case& which, const Mode& mode, const std::string& path);

}  // namespace caustream::stability
