#include "render/passes/map_resolve.h"

#include "shaders/shared/layout.h"

namespace caustream::render {

void MapResolve::run(const Inputs& in, gl::Texture& concentration, const gl::Buffer& ledger) {
    concentration.ensure(in.size, in.size, GL_RGBA32F, "spectral map");
    const GLuint program = shaders_.program("map_resolve");
    glUseProgram(program);
    const gl::Uniforms uniforms(program);
    setView(uniforms, "u_view", in.view);
    uniforms.set("u_firstTexel", in.firstTexel)
        .set("u_xyzToRgb", in.xyzToRgb)
        .set("u_fluxPerFixed", static_cast<float>(in.fluxPerFixed))
        .set("u_luminance", static_cast<float>(in.ledgerPerFixed));
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindMap, in.map.get());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindLedger, ledger.get());
    glBindImageTexture(0, concentration.get(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
    const int perGroup = layout::kGroupSize * layout::kScanTexels;
    glDispatchCompute(static_cast<GLuint>((in.size * in.size + perGroup - 1) / perGroup), 1, 1);
}

}  // namespace caustream::render
