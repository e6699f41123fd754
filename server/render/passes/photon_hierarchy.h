// The photons of a caster, found from coarse to fine in the mip levels of its image (Wyman and Nichols 2009, Adaptive
// Caustic Maps; Blanchette 2012, section 3.1): a cell with caster in it becomes four, any other is dropped.
#pragma once
#include <array>

#include "gl/names.h"
#include "gl/shader_library.h"

namespace caustream::render {

// How many levels can be traversed when `asked` for: a level has half the next finer one's cells a side, exactly.
int hierarchyLevels(int side, int asked);

// Points in a buffer whose number the GPU knows: the result of a transform feedback.
struct PhotonPoints {
    gl::Buffer cells;                 // x | y << 16 in the front layer, each a uint
    gl::VertexArray vertices;         // attribute 0
    gl::TransformFeedback feedback;   // glDrawTransformFeedback draws them
};

class PhotonHierarchy {
   public:
    struct Inputs {
        const gl::Texture& front;     // caster_layers, square, with levels + 1 mip levels; those above the first are made here
        int levels;                   // hierarchyLevels() of its side
        GLuint query = 0;             // takes the number of photons (GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN); 0: none
    };

    explicit PhotonHierarchy(gl::ShaderLibrary& shaders)
        : shaders_(shaders),
          empty_(gl::makeVertexArray()),
          nowhereImage_(1, 1, GL_RGBA8, "nowhere"),
          nowhere_(gl::makeFramebuffer("nowhere", {nowhereImage_.get()})) {}

    // The texels of `front` that hold the caster, each once; valid until the next run.
    const PhotonPoints& run(const Inputs& in);

   private:
    gl::ShaderLibrary& shaders_;
    gl::VertexArray empty_;
    gl::Texture nowhereImage_;             // GL wants somewhere to draw, though nothing is drawn
    gl::Framebuffer nowhere_;
    std::array<PhotonPoints, 2> points_;   // a level is read from one and written to the other
};

}  // namespace caustream::render
