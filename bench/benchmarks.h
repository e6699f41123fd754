// What caustream-bench measures. Everything prints; nothing asserts.
#pragma once
#include <string>

namespace caustream::bench {

struct FrameOptions {
    std::string scene = "sphere", gpu = "auto";
    int frames = 30;            // counted, after a warm-up of a sixth as many
    int photonGrid = 180;       // about 25,500 photons on the sphere
    int size = 512;             // of picture and map
};
// Whole frames through the pipeline after a light move and after a camera move: 1, 7 and 21 wavelengths, and the sphere
// at 2.5 and 33% of the light's cone. Medians.
int frameTime(const FrameOptions& options);

struct StreamOptions {
    std::string url = "http://127.0.0.1:9720";
    std::string scene = "sphere";
    int frames = 60;
};
// Frames of a moving light through the socket: what encoding, sending and decoding add to rendering.
int streamTime(const StreamOptions& options);

// Milliseconds for a fixed loop of arithmetic on one core, to set beside absolute times of different machines.
double calibrationMs();

}  // namespace caustream::bench
