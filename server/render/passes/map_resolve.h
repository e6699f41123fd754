// Fixed-point map -> concentration in linear BT.709: sums the pyramid that the photons were deposited in.
#pragma once
#include <array>
#include <glm/mat3x3.hpp>

#include "gl/names.h"
#include "gl/shader_library.h"
#include "render/passes/map_adapt.h"
#include "render/view.h"
#include "shaders/shared/layout.h"

namespace caustream::render {

class MapResolve {
   public:
    struct Inputs {
        const gl::Buffer* map;            // photon_trace, kMapWords a texel; null: `kept`
        const KeptLevels* kept = nullptr; // map_adapt
        const View& view;
        const gl::Texture& receivers;     // receiver_depth of that view, `size` texels a side
        int size;                         // texels a side of the finest level
        int levels;                       // of the pyramid, 1..kMostLevels, each half as many texels a side
        int firstTexel;                   // of the finest level in the buffer; the others follow
        glm::mat3 xyzToRgb;
        double fluxPerFixed, ledgerPerFixed;
        bool judged;                      // book what estimateError() asks for
    };

    explicit MapResolve(gl::ShaderLibrary& shaders) : shaders_(shaders) {}
    // Fills `concentration` (RGBA32F; rgb 1 = as bright as direct light, a the receiver's layer value) and books the deposited flux in `ledger`.
    void run(const Inputs& in, gl::Texture& concentration, const gl::Buffer& ledger);
    static void warmUp(gl::ShaderLibrary& shaders);

   private:
    gl::ShaderLibrary& shaders_;
    gl::BufferTexture texels_;                              // the map as RGBA32UI
    std::array<gl::Texture, layout::kMostLevels> coarse_;   // RGBA32F XYZ and even - odd Y, by level; the finest goes to the caller
};

}  // namespace caustream::render
