// What is seen through and on a caster: per wavelength a refracted ray through its two layers into the picture of the
// receivers, absorption along the way, Fresnel at both surfaces, the key light's highlight.
#pragma once
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "gl/names.h"
#include "gl/shader_library.h"
#include "render/lighting.h"
#include "render/omission.h"
#include "render/passes/camera_casters.h"
#include "render/view.h"

namespace caustream::render {

class DispersiveRefraction {
   public:
    static constexpr int kMaxWavelengths = 64;

    struct Wavelength {
        float index = 1.5f;           // of the glass over that of the outside
        glm::vec3 rgb{1.0f};          // linear BT.709 weight; all weights sum to (1, 1, 1)
        float absorptionPerM = 0.0f;
    };
    struct Glass {
        std::vector<Wavelength> wavelengths;  // 1..kMaxWavelengths; one is enough where nothing depends on wavelength
        bool thinWalled = false;              // no refraction: tinted, straight through
        glm::vec3 tint{1.0f};                 // linear; thin walls only
    };
    struct Inputs {
        const View& view;                     // the camera's
        const gl::Texture& front;             // RGBA32F caster_layers in that view, defined within `box`
        const gl::Texture& back;
        PixelBox box;                         // from CameraCasters::run; not empty
        const scene::Bounds& bounds;          // of the caster, world space
        const gl::Texture& receiversDepth;    // DEPTH_COMPONENT32F layer of camera_receivers
        const Glass& glass;
        const Lighting& lighting;
        const gl::Texture* frontDepth = nullptr;   // of `front`: blocks of pixels that hold none of it cost nothing
    };
    struct Settings {
        int backSteps = 4;                    // Newton steps to the exit point, 1..16
        int receiverSteps = 4;                // steps of the search in the receivers' picture, 1..32
        int bounces = 2;                      // interfaces met inside after the second, 0..16
        bool split = false;                   // bounces for up to 8 indices instead of one mean ray: several times the cost
        Omissions forced{};                   // that are done all the same
    };

    explicit DispersiveRefraction(gl::ShaderLibrary& shaders);

    // Once per frame, before the first caster: keeps a copy of `frame` (RGBA16F from camera_receivers) to look into.
    void begin(const gl::Texture& frame);
    // Draws one caster into `frame`. Casters come back to front; each sees those before it.
    void run(const Inputs& in, const Settings& settings, gl::Texture& frame);
    void warmUp();

   private:
    gl::ShaderLibrary& shaders_;
    gl::Texture background_;                  // RGBA16F, the frame so far
    gl::Texture surroundings_;                // RGBA16F, 8 x 8 means of it: where rays go that leave the picture
    gl::Sampler linear_;
    gl::VertexArray vertexArray_;             // empty: core profile draws nothing without one
};

}  // namespace caustream::render
