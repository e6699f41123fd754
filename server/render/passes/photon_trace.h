// Refracts every photon at its wavelengths through one caster and deposits it in the fixed-point spectral map.
#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "gl/names.h"
#include "gl/shader_library.h"
#include "render/view.h"
#include "scene/scene.h"

namespace caustream::render {

struct TracedWavelength {
    double nm = 0.0;
    double indexRatio = 1.0;          // outside / inside the caster
    double absorptionPerM = 0.0;
    double luminance = 0.0;           // share of the ledger; sums to 1
    glm::dvec3 xyz{0.0};              // weight in the map
};

// A place of a continuous spectrum, from violet to red, uniform in 1/lambda^2.
struct SpectrumStep {
    glm::dvec3 cumulativeXyz{0.0};    // of the light up to here
    double indexRatio = 1.0;          // outside / inside the caster
    double absorptionPerM = 0.0;
};

class PhotonTrace {
   public:
    struct Inputs {
        const gl::Texture &front, &back;                     // caster_layers: emission view, back view
        const gl::Texture &receivers, &outerReceivers;       // receiver_depth: map view, outer view
        const View &emission, &backView, &mapView, &outerView;
        const gl::Buffer& list;                              // photon_list
        const scene::Light& light;
        GLuint cookie = 0;
        std::vector<TracedWavelength> wavelengths;           // <= kMostWavelengths
        // Continuous: kSpectrumSteps + 1 places; the wavelengths are then the 2..kMostNodes nodes of it, ends included, and the
        // luminance of each is that of the interval from it to the next. Empty: exact wavelengths.
        std::vector<SpectrumStep> spectrum = {};
        int bands = 0;                                       // 0: XYZ; else one band per wavelength, of this many
        double fixedPerFlux = 1.0, ledgerPerFlux = 1.0;
        int levels = 1;                                      // of the inner map's pyramid
        int backSteps = 4, receiverSteps = 6;
        float exitToleranceM = 1e-3f, reachM = 100.0f;
        const gl::Buffer* residuals = nullptr;               // kResidualHistograms x kResidualBins u32, to be counted up
        bool absorption = false;                             // looked for even where no wavelength has any
    };
    struct Outputs {
        const gl::Buffer& map;        // u32, texel-major: levels of the inner map, then the outer's; kMapWords or `bands` each
        const gl::Buffer& ledger;     // kLedgerBanks x kLedgerRows u32
    };

    explicit PhotonTrace(gl::ShaderLibrary& shaders) : shaders_(shaders) {}
    void run(const Inputs& in, const Outputs& out);
    // `nodes`: of a continuous spectrum.
    static void warmUp(gl::ShaderLibrary& shaders, int nodes);

   private:
    void dispatch(const Inputs& in, int retryList, const gl::Buffer& groups);   // retryList < 0: all photons

    gl::ShaderLibrary& shaders_;
    gl::Buffer retry_;                // photons and wavelengths for the other two dispatches
};

}  // namespace caustream::render
