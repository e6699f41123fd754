// How much the spectral map would change if each wavelength's light were spread over the stretch that it stands for.
#pragma once
#include <glm/vec2.hpp>

#include "gl/names.h"
#include "gl/shader_library.h"

namespace caustream::render {

class SpectralStep {
   public:
    struct Inputs {
        const gl::Texture& map;           // RGBA32F concentration, of map_resolve
        glm::vec2 stepTexels;             // along x and y, >= 0
        double ledgerPerTexel;            // ledger units per texel of concentration 1
    };

    explicit SpectralStep(gl::ShaderLibrary& shaders)
        : shaders_(shaders), linear_(gl::makeSampler(GL_LINEAR, GL_CLAMP_TO_EDGE, "spectral step")) {}
    // Books into `ledger`, rows kLedgerStep and kLedgerStepOf.
    void run(const Inputs& in, const gl::Buffer& ledger);
    static void warmUp(gl::ShaderLibrary& shaders);

   private:
    gl::ShaderLibrary& shaders_;
    gl::Sampler linear_;
};

}  // namespace caustream::render
