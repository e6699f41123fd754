#include "render/passes/map_adapt.h"

#include <utility>

#include "gl/uniforms.h"

namespace caustream::render {

void MapAdapt::run(const Inputs& in, KeptLevels& kept, const gl::Buffer& ledger) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindLedger, ledger.get());
    texels_.view(in.sums, GL_RGBA32UI), counts_.view(in.landings, GL_R32UI);
    for (int level = 0; level < in.levels; ++level) {
        const auto at = static_cast<std::size_t>(level);
        const int size = in.size >> level;
        const bool top = level + 1 == in.levels;
        kept[at].ensure(size, size, GL_RGBA32F, "kept light");
        // A pyramid of one level, or its top: all of it stays
        if (top && level > 0) {
            std::swap(kept[at], rest_[at]);
            break;
        }
        const std::size_t above = top ? at : at + 1;
        gl::Texture &rest = rest_[above], &total = total_[above];
        rest.ensure(size / 2, size / 2, GL_RGBA32F, "light to be spread");
        total.ensure(size / 2, size / 2, GL_RG32F, "landings below");

        const GLuint program = shaders_.program("map_adapt", {{"FINEST", level == 0 ? 1 : 0}});
        glUseProgram(program);
        gl::Uniforms(program).set("u_sums", 0).set("u_restBelow", 1).set("u_totalBelow", 2).set("u_landings", 3).set("u_cells", level == 1 ? static_cast<float>(in.ledgerPerFixed) : 0.0f).set("u_enough", top ? 0.0f : static_cast<float>(in.enough));
        glBindTextureUnit(0, texels_.get());
        glBindTextureUnit(3, counts_.get());
        if (level > 0) glBindTextureUnit(1, rest_[at].get()), glBindTextureUnit(2, total_[at].get());
        glBindImageTexture(0, kept[at].get(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
        glBindImageTexture(1, rest.get(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
        glBindImageTexture(2, total.get(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RG32F);
        const int texels = (size / 2) * (size / 2);
        glDispatchCompute(static_cast<GLuint>((texels + layout::kGroupSize - 1) / layout::kGroupSize), 1, 1);
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);   // this level -> the next coarser, map_resolve
    }
}

}  // namespace caustream::render
