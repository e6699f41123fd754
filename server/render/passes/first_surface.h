// Labels of what the camera sees first, at each pixel's middle: normal, distance, which caster. Needs no light.
#pragma once
#include <span>

#include "gl/names.h"
#include "gl/shader_library.h"
#include "render/gpu_scene.h"
#include "render/view.h"
#include "scene/scene.h"

namespace caustream::render {

class FirstSurface {
   public:
    struct Inputs {
        const GpuScene& scene;
        std::span<const scene::Material> materials;  // Scene::materials: which objects are casters
        const View& view;                            // the camera's
        int width, height;                           // pixels
    };
    struct Outputs {
        gl::Texture& surface;  // RGBA32F: xyz unit normal in world space, of the side that is seen; w distance along the
                               //   view axis in m. All 0 where there is nothing
        gl::Texture& label;    // R32F: n for the n-th object that is a caster, from 1; 0 for receivers and nothing
    };

    explicit FirstSurface(gl::ShaderLibrary& shaders) : shaders_(shaders) {}

    // Makes the outputs anew if their size is another.
    void run(const Inputs& in, const Outputs& out);

   private:
    gl::ShaderLibrary& shaders_;
    gl::Texture depth_;
};

}  // namespace caustream::render
