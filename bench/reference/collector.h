// Where landings are added up: windows and maps, for one half of the photons.
#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "bench/reference/surfaces.h"
#include "bench/reference/tracer.h"

namespace caustream::tracer {

// A photon's wavelength as it lands: which channel of `bands` it is (-1: none), or what it adds to XYZ.
struct Carried {
    int band = -1;
    glm::dvec3 xyz{0.0};
    double share = 0.0;     // of it in means over wavelengths
};

// Sums of flux, one collector a half. Read with finish().
class Collector {
 public:
    Collector(const World& world, const Settings& settings, const Surfaces& surfaces);

    // `flux` arrives at `point` along unit `direction` on a receiver of unit normal `normal` (either way round).
    void land(const glm::dvec3& point, const glm::dvec3& direction, const glm::dvec3& normal, const Carried& carried, double flux);

    // Both halves' means into `result`, with the errors that their differences tell.
    static void finish(const Collector& a, const Collector& b, Result& result);

 private:
    struct Sums {
        std::vector<double> bands, xyz;   // [channel][cell]
        double hidden = 0.0;
    };
    struct WindowFrame {
        glm::dvec3 normal{0.0}, u{0.0}, v{0.0};   // u and v over their squared lengths
    };
    void add(Sums& sums, std::size_t cells, std::size_t cell, const Carried& carried, double flux) const;
    bool lightSees(const glm::dvec3& point, const glm::dvec3& direction, const glm::dvec3& normal) const;
    std::vector<double> extents(const MapView& map) const;

    const Settings& settings_;
    const Surfaces& surfaces_;
    const Light& light_;
    std::vector<WindowFrame> frames_;
    std::vector<Sums> windows_, maps_;
};

}  // namespace caustream::tracer
