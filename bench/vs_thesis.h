// The thesis's tables 3 and 4 measured here, for its algorithm and for ours.
#pragma once
#include <string>

#include "bench/accuracy/study.h"

namespace caustream::bench {

struct VsThesisOptions {
    int lightView = 512;           // texels a side of the published algorithm's view from the light, and of every map
    bool quick = false;            // the sphere alone, at the two outermost shares
};

// Prints both tables and then each claim with its figure and whether it is met. Returns the same as Markdown.
std::string vsThesis(Study& study, const VsThesisOptions& options);

}  // namespace caustream::bench
