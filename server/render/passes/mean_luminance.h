// How bright a picture is on the whole.
#pragma once
#include "gl/names.h"
#include "gl/shader_library.h"

namespace caustream::render {

class MeanLuminance {
   public:
    explicit MeanLuminance(gl::ShaderLibrary& shaders) : shaders_(shaders) {}

    // Mean over the pixels of what `present` makes of `image` (linear) at `scale`: luminance after the tone curve, 0..1,
    // before sRGB encodes it. Waits for the GPU.
    double of(const gl::Texture& image, float scale);

   private:
    gl::ShaderLibrary& shaders_;
    gl::Buffer sums_;
};

}  // namespace caustream::render
