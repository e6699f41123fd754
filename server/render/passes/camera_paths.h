// The casters as the camera sees them, exactly: wavelengths followed through every surface, with bounces, total
// reflection, nested glass and mirrors, to the receivers' lit colours or the environment.
#pragma once
#include <glm/mat3x3.hpp>
#include <memory>
#include <vector>

#include "gl/names.h"
#include "gl/shader_library.h"
#include "render/exact_surfaces.h"
#include "render/gpu_scene.h"
#include "render/lighting.h"
#include "render/passes/camera_casters.h"
#include "render/receiver_shading.h"
#include "render/spectral_table.h"
#include "render/view.h"

namespace caustream::render {

// Boxes that overlap made one, so that no pixel is in two.
std::vector<PixelBox> apart(std::vector<PixelBox> boxes);

class CameraPaths {
   public:
    struct Inputs {
        const ExactSurfaces& surfaces;
        const SpectralEntries& spectrum;
        const glm::mat3& xyzToRgb;
        const scene::Scene& scene;
        const GpuScene& gpu;
        const Lighting& lighting;
        const View& view;                    // the camera's
        const gl::Texture& receiversDepth;   // DEPTH_COMPONENT32F layer of camera_receivers in that view
        const gl::Texture* mean = nullptr;   // of the samples before of this picture, if there were any
        bool everywhere = false;             // outside the casters' boxes, too: only for measuring
    };
    struct Settings {
        int rays = 3;                        // wavelengths a pixel, 1..64
        int bounces = 2;                     // reflections that are followed, 0..32
        int branches = 6;                    // of several casters: how often a ray may part, 0..6
        float least = 1.0f / 256.0f;         // of a pixel's light: weaker is not followed on its own
        bool caustics = true;                // on receivers that the picture does not show
        float rotation = 0.0f;               // 0..1: which wavelengths
        int sample = 0;                      // which way goes a ray that parts no more; 0: the stronger one's
    };

    explicit CameraPaths(gl::ShaderLibrary& shaders);

    // Draws all casters into `frame` (RGBA16F from camera_receivers, mirrors left out).
    void run(const Inputs& in, const Settings& settings, gl::Texture& frame);

   private:
    void setReceivers(const Inputs& in);

    gl::ShaderLibrary& shaders_;
    ReceiverShading shading_;
    SpectralTable table_;
    gl::Texture background_;                 // RGBA16F, the frame without casters
    gl::Buffer receivers_;                   // two vec4 an object of the geometry
    gl::BufferTexture receiverTexels_;
    std::vector<glm::vec4> receiversNow_;
    std::weak_ptr<const scene::Geometry> geometry_;   // that textureMeans_ are of
    std::vector<glm::vec3> textureMeans_;
    gl::Sampler linear_;
    gl::VertexArray vertexArray_;            // empty: core profile draws nothing without one
};

}  // namespace caustream::render
