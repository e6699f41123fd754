// The casters in the camera's picture as published (Blanchette 2012, section 3.2 and appendix A): one ray for each
// wavelength into the picture of the receivers, over the whole image. Casters do not see one another.
#pragma once
#include "gl/names.h"
#include "gl/shader_library.h"
#include "render/lighting.h"
#include "render/passes/dispersive_refraction.h"
#include "render/view.h"

namespace caustream::render {

class ThesisRefraction {
   public:
    struct Inputs {
        const View& view;                          // the camera's
        const gl::Texture& front;                  // RGBA32F caster_layers in that view, cleared everywhere
        const gl::Texture& back;
        const gl::Texture& receiversDepth;         // DEPTH_COMPONENT32F layer of the receivers
        const DispersiveRefraction::Glass& glass;  // not thin-walled
        const Lighting& lighting;
    };

    explicit ThesisRefraction(gl::ShaderLibrary& shaders);

    // Once per frame, before the first caster: keeps a copy of `frame` (RGBA16F, the receivers) to look into.
    void begin(const gl::Texture& frame);
    void run(const Inputs& in, gl::Texture& frame);

   private:
    gl::ShaderLibrary& shaders_;
    gl::Texture background_;                       // RGBA16F
    gl::Sampler linear_;
    gl::VertexArray vertexArray_;                  // empty: core profile draws nothing without one
};

}  // namespace caustream::render
