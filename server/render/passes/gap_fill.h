// The thesis's gap filling (Blanchette 2012, section 4.2 and appendix A): a dark texel between two lit stretches of its
// row or column takes a share of them. Adds energy, so it is never in use unless asked for.
#pragma once
#include "gl/names.h"
#include "gl/shader_library.h"

namespace caustream::render {

class GapFill {
   public:
    explicit GapFill(gl::ShaderLibrary& shaders) : shaders_(shaders) {}
    // Replaces `concentration` (RGBA32F) by its filled copy.
    void run(gl::Texture& concentration);

   private:
    gl::ShaderLibrary& shaders_;
    gl::Texture rows_, filled_;
};

}  // namespace caustream::render
