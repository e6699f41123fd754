// The weighted mean of pictures of one view, one by one.
#pragma once
#include "gl/names.h"
#include "gl/shader_library.h"

namespace caustream::render {

class PictureMean {
   public:
    explicit PictureMean(gl::ShaderLibrary& shaders) : shaders_(shaders) {}

    // Moves `mean` (RGBA32F, made to fit) towards `sample` (RGBA16F) by `share`; 1 forgets what was there.
    void run(const gl::Texture& sample, float share, gl::Texture& mean);

   private:
    gl::ShaderLibrary& shaders_;
};

}  // namespace caustream::render
