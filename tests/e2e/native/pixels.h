// Pictures and maps read back from files, and what tests ask of them.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace caustream::e2e {

struct Pixels {
    int width = 0, height = 0, bands = 0;
    std::vector<float> values;  // interleaved; pictures 0..255

    float luminance(int x, int y) const;     // BT.709 weights; of one band: itself
    float largest(int x, int y) const;       // of the bands
    double quantile(double fraction) const;  // of the luminance
    double mean() const;                     // of the luminance
};

// They throw std::runtime_error, which fails the test.
Pixels readPng(const std::string& file);
Pixels readJpeg(const std::string& file);
Pixels readNpy(const std::string& file);

struct Centroid {
    double x = 0, y = 0;  // pixels
    int count = 0;
};
// Of the pixels whose luminance exceeds `threshold`.
Centroid centroidAbove(const Pixels& pixels, double threshold);

}  // namespace caustream::e2e
