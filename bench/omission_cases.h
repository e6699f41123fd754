// A scene for each thing that frames leave out, where doing it all the same shows: the bench times both ways, a test
// compares their pictures.
#pragma once
#include <vector>

#include "render/frame.h"

namespace caustream::bench {

enum class Moves { Light, Camera };

struct OmissionCase {
    render::Omission omission;
    render::Request request;     // forces nothing
    Moves moves;                 // what changes from frame to frame; the other side's results are kept
    int tolerance = 0;           // of 255: how far the pictures may be apart
    const char* why = "";        // they are at all

    // The request after `step` moves, each too small to be seen.
    render::Request moved(int step) const;
};

// Pictures of `size` pixels and maps of as many texels a side. In the order of render::Omission, which has a case each.
std::vector<OmissionCase> omissionCases(int size, int photonGrid);

}  // namespace caustream::bench
