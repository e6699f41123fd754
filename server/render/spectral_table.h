// What light of each wavelength does in each caster, and what colour it has, as shaders/common/interfaces.glsl looks it up.
#pragma once
#include <span>
#include <vector>

#include "gl/names.h"
#include "gl/uniforms.h"
#include "optics/colour.h"
#include "render/exact_surfaces.h"

namespace caustream::render {

// Wavelengths by number. Exact ones: each an entry, in the set's order, with its own XYZ. A continuous spectrum: entries
// that carry equal parts of X + Y + Z, so that light where no one sees it is not traced; each has the XYZ of all the
// entries' worth: the mean over the entries is the whole light's.
struct SpectralEntries {
    std::vector<double> nm;
    std::vector<glm::dvec3> xyz;      // of light that has this entry alone
    bool continuous = false;
};
inline constexpr int kContinuousEntries = 1024;
SpectralEntries spectralEntries(const optics::WavelengthSet& set);

class SpectralTable {
   public:
    // Uploads; GL thread.
    void fill(const scene::Scene& scene, std::span<const ExactCaster> casters, const SpectralEntries& entries);
    // Two texture units from `firstUnit` on, and the uniforms of interfaces.glsl.
    void bind(const gl::Uniforms& uniforms, GLuint firstUnit) const;

   private:
    gl::Buffer glasses_, colours_;
    gl::BufferTexture glassTexels_, colourTexels_;
    int casters_ = 0;
    float outsideIndex_ = 1.0f;
};

}  // namespace caustream::render
