#include "render/passes/gap_fill.h"

#include <utility>

#include "gl/uniforms.h"
#include "shaders/shared/layout.h"

namespace caustream::render {

void GapFill::run(gl::Texture& concentration) {
    const int size = concentration.width();
    rows_.ensure(size, size, GL_RGBA32F, "gap fill rows");
    filled_.ensure(size, size, GL_RGBA32F, "gap fill");
    const auto sweep = [&](int columns, const gl::Texture& to) {
        const GLuint program = shaders_.program("gap_fill", {{"COLUMNS", columns}});
        glUseProgram(program);
        gl::Uniforms(program).set("u_map", 0).set("u_rows", 1);
        glBindTextureUnit(0, concentration.get());
        glBindTextureUnit(1, rows_.get());
        glBindImageTexture(0, to.get(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
        glDispatchCompute(static_cast<GLuint>((size + layout::kGroupSize - 1) / layout::kGroupSize), 1, 1);
    };
    sweep(0, rows_);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);   // rows -> columns
    sweep(1, filled_);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);   // filled map -> camera_receivers
    std::swap(concentration, filled_);
}

}  // namespace caustream::render
