// Traces photons exactly through every surface of every caster and adds them to the spectral map in 64 bits.
#pragma once
#include <cstdint>

#include "gl/names.h"
#include "gl/shader_library.h"
#include "render/exact_surfaces.h"
#include "render/spectral_table.h"
#include "render/view.h"
#include "scene/scene.h"

namespace caustream::render {

class PhotonPaths {
   public:
    struct Inputs {
        const ExactSurfaces& surfaces;
        const SpectralTable& table;
        const View &emission, &mapView, &outerView;          // the outer view shares the map view's space
        const gl::Texture &receivers, &outerReceivers;       // receiver_depth of the map view, of the outer view
        const scene::Light& light;
        GLuint cookie = 0;
        int emitter = 0;                                     // number of the caster that must be met first
        std::uint32_t firstPhoton = 0, photons = 0;          // of this caster's endless row of them
        int spectra = 1;                                     // wavelengths a photon
        int firstEntry = 0, entries = 1;                     // of the table: the first one used; all, or with `bands` their number
        bool continuous = false;
        double bandShare = 0.0;                              // > 0: a sum for each wavelength, whose share of the luminance this is
        bool exactReceivers = false;
        bool hidden = true;                                  // a receiver may hide another from the light
        int bounces = 8, receiverSteps = 6;
        double fixedPerFlux = 1.0, ledgerPerFlux = 1.0;      // units per photon's flux: 1 at the brightest place of the view
        float reachM = 100.0f;                               // farther than any receiver
    };
    struct Outputs {
        const gl::Buffer &map, &outerMap;                    // u32, texel-major, kWideWords (with bands: 2 a band) each
        const gl::Buffer &landings, &outerLandings;          // u32 a texel: how many there were
        const gl::Buffer& ledger;                            // kLedgerBanks x kLedgerRows u32
    };

    explicit PhotonPaths(gl::ShaderLibrary& shaders) : shaders_(shaders) {}
    void run(const Inputs& in, const Outputs& out);

   private:
    gl::ShaderLibrary& shaders_;
};

}  // namespace caustream::render
