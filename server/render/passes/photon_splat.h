// Refracts every photon at its wavelengths in a geometry shader and adds a Gaussian splat for each to the spectral map, by
// blending (Blanchette 2012, appendix A).
#pragma once
#include <glm/vec4.hpp>
#include <vector>

#include "gl/names.h"
#include "gl/shader_library.h"
#include "render/passes/photon_hierarchy.h"
#include "render/view.h"
#include "scene/scene.h"

namespace caustream::render {

class PhotonSplat {
   public:
    struct Wavelength {
        float index = 1.5f;               // of the caster over that of what is around it
        glm::vec4 weight{1.0f};           // of its splat in the map's four channels
    };
    struct Inputs {
        const gl::Texture &front, &back;  // caster_layers in the light's view
        const gl::Texture& receivers;     // receiver_depth in that view
        const View& view;                 // the light's, of layers, receivers and map
        const PhotonPoints& photons;      // photon_hierarchy
        const scene::Light& light;
        GLuint cookie = 0;                // texture, 0: none
        const std::vector<Wavelength>& wavelengths;   // 1..64
    };

    explicit PhotonSplat(gl::ShaderLibrary& shaders)
        : shaders_(shaders), linear_(gl::makeSampler(GL_LINEAR, GL_CLAMP_TO_EDGE, "photon splat")) {}

    // Adds to `map` (RGBA32F, concentration); `alpha`: to its fourth channel too.
    void run(const Inputs& in, bool alpha, const gl::Texture& map);

   private:
    gl::ShaderLibrary& shaders_;
    gl::Sampler linear_;
};

}  // namespace caustream::render
