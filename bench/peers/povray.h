// POV-Ray as another program: an independent photon mapper to compare with. Debian's package is called povray.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace caustream::peers {

struct PovrayImage {
    int side = 0;
    std::vector<double> green;           // linear, 0..1 of what 16 bits hold; rows from the top
    bool clipped = false;                // some pixel is at the end of the scale
    double cpuSeconds = 0, seconds = 0;  // of the whole process, user and system
    std::uint64_t shot = 0, stored = 0;  // photons, as it says
};

// Whether the program is there.
bool havePovray();

// Renders a scene file's text, `side` x `side` pixels, no anti-aliasing, on `threads` threads, in a folder of its own that
// is gone afterwards. Throws Error with what the program said.
PovrayImage runPovray(const std::string& scene, int side, int threads);

}  // namespace caustream::peers
