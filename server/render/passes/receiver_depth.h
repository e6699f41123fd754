// Depth of the receivers (and of the casters, for shadows) from one view of the light.
#pragma once
#include <functional>

#include "gl/names.h"
#include "gl/shader_library.h"
#include "render/gpu_scene.h"
#include "render/view.h"

namespace caustream::render {

class ReceiverDepth {
   public:
    struct Inputs {
        const GpuScene& scene;
        const std::vector<scene::Material>& materials;
        const View& view;
        int size;                 // texels a side
        bool casters = false;     // also the casters that cast a shadow: those that bend light
        double outsideIndex = 1.0;
        std::function<bool(const scene::Object&)> leftOut{};   // receivers that are not drawn; none when empty
    };

    explicit ReceiverDepth(gl::ShaderLibrary& shaders) : shaders_(shaders) {}

    // Fills `depth` (DEPTH_COMPONENT32F, made anew if its size is another) with layer values of view.glsl.
    void run(const Inputs& in, gl::Texture& depth);

   private:
    gl::ShaderLibrary& shaders_;
};

}  // namespace caustream::render
