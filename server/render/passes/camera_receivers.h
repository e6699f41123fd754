// The receivers as the camera sees them: Lambert shading under the key light with its shadow and the projected spectral
// map, the other lights unshadowed, the environment as a dim hemisphere.
#pragma once
#include <span>

#include "gl/names.h"
#include "gl/shader_library.h"
#include "render/gpu_scene.h"
#include "render/lighting.h"
#include "render/omission.h"
#include "render/receiver_shading.h"
#include "render/view.h"
#include "scene/scene.h"

namespace caustream::render {

// Whether a material needs more than Lambert under one light: a highlight. Roughness 1 has none worth its price.
bool glossy(const scene::Material& material);

// Whether any of the object can be in a light's view; what is not needs no lookup there.
bool inView(const scene::Object& object, const View& view);

class CameraReceivers {
   public:
    struct Inputs {
        const GpuScene& scene;
        std::span<const scene::Material> materials;  // Scene::materials; casters are left out of the picture
        const Lighting& lighting;
        const View& view;                            // the camera's, perspective or parallel
        int width, height;                           // pixels
        bool asPublished = false;                    // thesis_receivers: the thesis's shading with its gains
        Omissions forced{};                          // that are done all the same
        bool mirrorsApart = false;                   // mirrors are left out, too
    };
    struct Outputs {
        gl::Texture& color;  // RGBA16F, linear BT.709 radiance over radianceUnit(); background: the environment. a = 1
        gl::Texture& depth;  // DEPTH_COMPONENT32F, layer value of view.glsl, 0 where there is no receiver
    };

    explicit CameraReceivers(gl::ShaderLibrary& shaders);

    // Makes the outputs anew if their size is another. Leaves them unbound; changes no state but the usual bindings.
    void run(const Inputs& in, const Outputs& out);
    // Compiles every variant, so that no frame has to.
    void warmUp();

   private:
    void setFrame(const Inputs& in, GLuint program) const;
    void setMaterial(const Inputs& in, const scene::Material& material, GLuint program) const;

    gl::ShaderLibrary& shaders_;
    ReceiverShading shading_;
    gl::Sampler trilinear_;
    gl::Texture white_;                              // where a texture is forced on what has none
};

}  // namespace caustream::render
