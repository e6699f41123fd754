#include "render/passes/spectral_step.h"

#include <algorithm>

#include "gl/uniforms.h"
#include "shaders/shared/layout.h"

namespace caustream::render {

namespace {
constexpr int kFewestTaps = 2, kMostTaps = 16;   // of a line; doubled until there is one a texel
}

void SpectralStep::run(const Inputs& in, const gl::Buffer& ledger) {
    int taps = kFewestTaps;
    while (taps < kMostTaps && static_cast<float>(taps) < std::max(in.stepTexels.x, in.stepTexels.y)) taps *= 2;
    const GLuint program = shaders_.program("spectral_step", {{"kTaps", taps}});
    glUseProgram(program);
    gl::Uniforms(program).set("u_map", 0).set("u_step", in.stepTexels).set("u_ledgerPerTexel", static_cast<float>(in.ledgerPerTexel));
    glBindTextureUnit(0, in.map.get());
    glBindSampler(0, linear_.get());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindLedger, ledger.get());
    const int blocks = (in.map.width() / 4) * (in.map.height() / 4);
    glDispatchCompute(static_cast<GLuint>((blocks + layout::kGroupSize - 1) / layout::kGroupSize), 1, 1);
    glBindSampler(0, 0);
}

void SpectralStep::warmUp(gl::ShaderLibrary& shaders) {
    for (int taps = kFewestTaps; taps <= kMostTaps; taps *= 2) shaders.program("spectral_step", {{"kTaps", taps}});
}

}  // namespace caustream::render
