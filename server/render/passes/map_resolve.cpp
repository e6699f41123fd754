#include "render/passes/map_resolve.h"

namespace caustream::render {

namespace {
std::vector<gl::Flag> flags(bool adapted, bool finest, bool judged, bool above, int views = 1) {
    return {{"ABOVE", above}, {"ADAPTED", adapted}, {"FINEST", finest}, {"JUDGED", judged}, {"kViews", views}};
}
}  // namespace

void MapResolve::run(const Inputs& in, gl::Texture& concentration, const gl::Buffer& ledger) {
    if (in.map) texels_.view(*in.map, GL_RGBA32UI), glBindTextureUnit(1, texels_.get());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindLedger, ledger.get());
    glBindTextureUnit(2, in.receivers.get());
    for (int level = in.levels - 1; level >= 0; --level) {
        const int size = in.size >> level;
        int first = in.firstTexel;
        for (int i = 0; i < level; ++i) first += (in.size >> i) * (in.size >> i);
        gl::Texture& out = level == 0 ? concentration : coarse_[static_cast<std::size_t>(level)];
        out.ensure(size, size, GL_RGBA32F, "spectral map");

        const bool above = level + 1 < in.levels;
        const GLuint program = shaders_.program("map_resolve", flags(in.kept != nullptr, level == 0, in.judged, above, viewsFlag({&in.view})));
        glUseProgram(program);
        const gl::Uniforms uniforms(program);
        setView(uniforms, "u_view", in.view);
        uniforms.set("u_firstTexel", first)
            .set("u_xyzToRgb", in.xyzToRgb)
            .set("u_fluxPerFixed", static_cast<float>(in.fluxPerFixed))
            .set("u_luminance", static_cast<float>(in.ledgerPerFixed))
            .set("u_above", 0)
            .set("u_map", 1)
            .set("u_kept", 1)
            .set("u_receivers", 2);
        if (in.kept) glBindTextureUnit(1, (*in.kept)[static_cast<std::size_t>(level)].get());
        if (above) glBindTextureUnit(0, coarse_[static_cast<std::size_t>(level) + 1].get());
        glBindImageTexture(0, out.get(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
        const int runs = (size + layout::kScanTexels - 1) / layout::kScanTexels * ((size + 1) / 2);
        glDispatchCompute(static_cast<GLuint>((runs + layout::kGroupSize - 1) / layout::kGroupSize), 1, 1);
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);   // this level -> the next finer
    }
}

void MapResolve::warmUp(gl::ShaderLibrary& shaders) {
    for (const bool above : {false, true}) {
        for (const bool finest : {false, true}) shaders.program("map_resolve", flags(false, finest, true, above));
    }
    shaders.program("map_resolve", flags(false, true, false, false));
}

}  // namespace caustream::render
