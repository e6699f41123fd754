// Front and back surface of one caster as seen from a view: normals and depth, in two culled draws. Serves the light's
// emission views and the camera's view (camera_casters).
#pragma once
#include <functional>

#include "gl/names.h"
#include "gl/shader_library.h"
#include "render/gpu_scene.h"
#include "render/view.h"

namespace caustream::render {

class CasterLayers {
   public:
    enum class Side { Front, Back };
    struct Inputs {
        const GpuScene& scene;
        const scene::Object& caster;
        const View& view;
        int width, height;
        // Draws what may stand before the caster (depth only); a caster's texel behind it stays empty. Null: nothing.
        std::function<void()> drawOccluders;
        int levels = 1;           // of `layer`'s storage; only the first is drawn
    };

    explicit CasterLayers(gl::ShaderLibrary& shaders) : shaders_(shaders) {}

    // Fills `layer` (RGBA32F, made anew if its size is another): xyz unit outward normal in view space, interpolated;
    // w the layer value of view.glsl, 0 where there is no surface. Back: the nearest surface that faces away.
    void run(const Inputs& in, Side side, gl::Texture& layer);
    // Of the last run: the layer values once more, as a depth image.
    const gl::Texture& depth() const { return depth_; }

   private:
    gl::ShaderLibrary& shaders_;
    gl::Texture depth_;
};

}  // namespace caustream::render
