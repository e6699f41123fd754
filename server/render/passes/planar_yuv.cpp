#include "render/passes/planar_yuv.h"

#include "gl/uniforms.h"

namespace caustream::render {

namespace {
constexpr int kGroup = 8, kWord = 4;   // threads a side, bytes: as the shader says
}

void PlanarYuv::run(const gl::Texture& image, PixelLayout layout, const Outputs& out) {
    const bool half = layout == PixelLayout::Yuv420;
    const Planes all = planesOf(layout, image.width(), image.height());
    const auto& [luma, cb, cr] = all.planes;
    out.planes.ensure(all.bytes, 0, "planes of the picture");
    const GLuint program = shaders_.program("planar_yuv", {{"HALF", half}});
    glUseProgram(program);
    gl::Uniforms(program)
        .set("u_image", 0)
        .set("u_size", glm::ivec2(image.width(), image.height()))
        .set("u_stride", glm::ivec2(luma.stride, cb.stride) / kWord)
        .set("u_offset", glm::ivec2(cb.offset, cr.offset) / kWord);
    glBindTextureUnit(0, image.get());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, out.planes.get());
    const auto groups = [](int threads) { return static_cast<GLuint>((threads + kGroup - 1) / kGroup); };
    glDispatchCompute(groups(cb.stride / kWord), groups(cb.height), 1);
}

void PlanarYuv::warmUp() {
    for (const bool half : {false, true}) shaders_.program("planar_yuv", {{"HALF", half}});
}

}  // namespace caustream::render
