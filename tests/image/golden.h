// Pictures kept as numbers, and how far a new one may be from them.
#pragma once
#include <string>
#include <vector>

namespace caustream::image {

struct Tolerance {
    double pixel = 0;      // |difference| of a channel over max(1, golden) that a pixel may show
    double fraction = 0;   // of the pixels that may show more
    double mean = 0;       // of all channels' differences
};

// Compares width x height RGB with `folder`/<name>.npy.gz. Empty when it is close enough; else what is wrong, with the ten
// worst pixels, and |difference| as <name>-difference.png in the working folder. NaN and infinity are always wrong.
std::string compareWithGolden(const std::string& folder, const std::string& name, const std::vector<float>& rgb, int width,
                              int height, const Tolerance& tolerance);

void writeGolden(const std::string& folder, const std::string& name, const std::vector<float>& rgb, int width, int height);

}  // namespace caustream::image
