// What the first frame after a light move takes in each mode, in turns; and photons of the gem's plane set by themselves.
#pragma once
#include <string>
#include <vector>

#include "bench/accuracy/renderer.h"
#include "bench/accuracy/subject.h"

namespace caustream::bench {

struct FirstFrame {
    std::string mode;
    double ms = 0, spreadMs = 0, cpuMs = 0;      // medians; between the quartiles
    std::uint32_t photons = 0;
    double ratio = 0;                            // over refined: median of the turns' own ratios
};
std::vector<FirstFrame> firstFrames(Renderer& renderer, const Subject& subject, int pictureSize, int turns);

struct PhotonTime {
    double ms = 0;                               // of the pass photon_paths, median
    std::uint32_t photons = 0;                   // that met the caster
    double msOfTenThousand() const { return photons > 0 ? ms * 1e4 / photons : 0.0; }
};
// 7 wavelengths, 8 bounces, about 10,000 photons.
PhotonTime photonTime(Renderer& renderer, const Subject& subject, int frames);

}  // namespace caustream::bench
