// Fixed-point map -> concentration in linear BT.709, smoothed only where photons are sparse.
#pragma once
#include <glm/mat3x3.hpp>

#include "gl/names.h"
#include "gl/shader_library.h"
#include "render/view.h"

namespace caustream::render {

class MapResolve {
   public:
    struct Inputs {
        const gl::Buffer& map;            // photon_trace, XYZ
        const View& view;
        int size;                         // texels a side
        int firstTexel;                   // of this map in the buffer
        glm::mat3 xyzToRgb;
        double fluxPerFixed, ledgerPerFixed;
    };

    explicit MapResolve(gl::ShaderLibrary& shaders) : shaders_(shaders) {}
    // Fills `concentration` (RGBA32F; rgb 1 = as bright as direct light) and books the deposited flux in `ledger`.
    void run(const Inputs& in, gl::Texture& concentration, const gl::Buffer& ledger);

   private:
    gl::ShaderLibrary& shaders_;
};

}  // namespace caustream::render
