// From an image of the pipeline to one that can be read back: exposure, tone curve, gamut and sRGB for the picture, false
// colour for everything else, plain floats where numbers are wanted. Turns rows so that row 0 is the top.
#pragma once
#include <glm/vec3.hpp>

#include "gl/names.h"
#include "gl/shader_library.h"

namespace caustream::render {

class Present {
   public:
    enum class Mode {
        Picture,   // exposure, tone curve, gamut, sRGB
        Linear,    // the input times `scale`, untouched otherwise
        Normals,   // xyz in -1..1 of a layer -> colour; empty texels black
        Layer,     // w of a layer or the red of a depth image: near bright, far dim, nothing black
        Map,       // rgb concentration on a log scale, 1 at mid grey
        Distance,  // w, a distance: mid grey at `scale`, brighter before it, darker behind, nothing black
        Label,     // red, a number from 1 on: a colour of its own; 0 black
    };
    struct Inputs {
        GLuint image = 0;          // linear; rows bottom to top
        Mode mode = Mode::Picture;
        float scale = 1.0f;        // Picture: 2^EV; Linear: unit of the output; Map: multiplies first; Distance: that is mid grey
        bool depthImage = false;   // Layer: the layer is in red (depth or R32F), not in w
        GLuint before = 0;         // Picture: the image that `image` takes the place of, or none
        bool resized = false;      // it has another size than `image`
        float share = 1.0f;        // of `image` after the tone curve, the rest is `before`
        bool downsample = false;   // the image is twice the output's size a side: 4x anti-aliasing
    };
    struct Outputs {
        gl::Texture& image;        // RGBA8 (sRGB code values) or RGBA32F, rows top to bottom
    };

    explicit Present(gl::ShaderLibrary& shaders)
        : shaders_(shaders), vertexArray_(gl::makeVertexArray()), linear_(gl::makeSampler(GL_LINEAR, GL_CLAMP_TO_EDGE, "present")) {}

    // Makes `out.image` anew if it is not width x height of `format` (GL_RGBA8 or GL_RGBA32F).
    void run(const Inputs& in, int width, int height, GLenum format, const Outputs& out);
    void warmUp();

   private:
    gl::ShaderLibrary& shaders_;
    gl::VertexArray vertexArray_;  // empty: core profile draws nothing without one
    gl::Sampler linear_;           // for what is resized
};

}  // namespace caustream::render
