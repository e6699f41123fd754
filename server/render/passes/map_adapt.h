// The sums of an exactly traced map into a pyramid: light stays in the finest texels that enough photons landed in.
#pragma once
#include <array>

#include "gl/names.h"
#include "gl/shader_library.h"
#include "shaders/shared/layout.h"

namespace caustream::render {

// By level, finest first: RGBA32F XYZ and even - odd Y, map units a texel. All levels together hold the map's light.
using KeptLevels = std::array<gl::Texture, layout::kMostLevels>;

class MapAdapt {
   public:
    struct Inputs {
        const gl::Buffer& sums;      // photon_paths, kWideWords a texel
        const gl::Buffer& landings;  // photon_paths, u32 a texel
        int size;                    // texels a side of the finest level
        int levels;                  // 1..kMostLevels
        double enough;               // landings that keep four texels sharp
        double ledgerPerFixed = 0.0; // 0: books nothing
    };

    explicit MapAdapt(gl::ShaderLibrary& shaders) : shaders_(shaders) {}
    // Also books what the halves of the photons differ by on cells of 4 x 4 texels, if there are that many levels.
    void run(const Inputs& in, KeptLevels& kept, const gl::Buffer& ledger);

   private:
    gl::ShaderLibrary& shaders_;
    gl::BufferTexture texels_, counts_;                          // the sums as RGBA32UI, the landings as R32UI
    std::array<gl::Texture, layout::kMostLevels> rest_, total_;  // on their way up, by level
};

}  // namespace caustream::render
