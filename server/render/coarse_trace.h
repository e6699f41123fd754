// A few hundred exact light paths on the CPU (Embree): where light lands, so that the map's view can be fitted to it.
#pragma once
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "render/exact_surfaces.h"
#include "render/view.h"
#include "scene/scene.h"

namespace caustream::render {

struct Landing {
    glm::vec3 position;   // on a receiver, world space
    float flux;           // relative
    int photon = 0;       // of the grid that it was traced in; its wavelengths follow each other
};

// 1 - cosine of a cone's half angle, exact for the narrowest.
float coneVersine(float halfAngleDeg);

// Fraction of the on-axis intensity that a spot sends along unit `direction` (KHR_lights_punctual); 1 for other lights.
float coneFalloff(const scene::Light& light, const glm::vec3& direction);

class CoarseTrace {
   public:
    explicit CoarseTrace(const scene::Scene& scene);
    ~CoarseTrace();

    // Traces `grid` x `grid` photons of the emission view through `caster` at each of `wavelengthsNm`: two interfaces,
    // interpolated normals, light lost to total reflection left out.
    std::vector<Landing> trace(const scene::Scene& scene, const scene::Light& light, const scene::Object& caster,
                               const View& emission, int grid, const std::vector<double>& wavelengthsNm) const;

    struct Paths {
        std::vector<Landing> landings;
        double met = 0.0;                  // share of the photons that met their caster first
    };
    // The same exactly, as traced mode has it: photons that meet the caster `first` before all else, at each wavelength
    // through every surface of `casters` (in the shaders' order) with both branches and up to `bounces` reflections.
    Paths paths(const scene::Scene& scene, const scene::Light& light, std::span<const ExactCaster> casters,
                std::size_t first, const View& emission, int grid, const std::vector<double>& wavelengthsNm, int bounces) const;

   private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace caustream::render
