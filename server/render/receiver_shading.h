// What shaders/common/receiver_shading.glsl has to know: lights, shadow, spectral map, environment.
#pragma once
#include "gl/names.h"
#include "gl/uniforms.h"
#include "render/gpu_scene.h"
#include "render/lighting.h"
#include "render/view.h"

namespace caustream::render {

class ReceiverShading {
   public:
    static constexpr GLuint kUnits = 4;   // texture units that bind() takes

    ReceiverShading();

    // Sets the uniforms of a program and binds the images and samplers to the units from `firstUnit` on.
    void bind(const gl::Uniforms& uniforms, GLuint firstUnit, const GpuScene& scene, const Lighting& lighting, const View& view) const;
    static void unbind(GLuint firstUnit);

   private:
    gl::Sampler linear_, shadow_;
};

bool hasCookie(const Lighting& lighting);

}  // namespace caustream::render
