// A presented picture as a JPEG encoder wants it: planes, in one buffer that is read back whole. 3 or 1.5 bytes a pixel
// instead of 4, and no conversion on the CPU.
#pragma once
#include "gl/names.h"
#include "gl/shader_library.h"
#include "render/frame.h"

namespace caustream::render {

class PlanarYuv {
   public:
    struct Outputs {
        gl::Buffer& planes;        // as planesOf() says, code values 0..255
    };

    explicit PlanarYuv(gl::ShaderLibrary& shaders) : shaders_(shaders) {}

    // `image`: RGBA8, sRGB code values, rows top to bottom. `layout`: a planar one.
    void run(const gl::Texture& image, PixelLayout layout, const Outputs& out);
    void warmUp();

   private:
    gl::ShaderLibrary& shaders_;
};

}  // namespace caustream::render
