// Compact list of the texels of a caster's front layer that the light reaches: the photons.
#pragma once
#include "gl/names.h"
#include "gl/shader_library.h"
#include "render/view.h"
#include "scene/scene.h"

namespace caustream::render {

// Sets what shaders/common/emission.glsl asks of the light, in the space of `view`.
void setEmission(const gl::Uniforms& uniforms, const scene::Light& light, const View& view, bool cookie);

class PhotonList {
   public:
    struct Inputs {
        const gl::Texture& front;     // of caster_layers, emission view
        const View& emission;
        const scene::Light& light;
        GLuint cookie = 0;            // texture, 0: none
    };

    explicit PhotonList(gl::ShaderLibrary& shaders) : shaders_(shaders) {}

    // Fills the list: dispatch size (3 uints), photon count, then x + y * width of each photon's texel, in any order.
    // Counts them in the ledger's row kLedgerPhotons.
    void run(const Inputs& in, gl::Buffer& list, const gl::Buffer& ledger);

   private:
    gl::ShaderLibrary& shaders_;
};

}  // namespace caustream::render
