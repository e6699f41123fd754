#include "render/passes/present.h"

#include "gl/uniforms.h"

namespace caustream::render {

namespace {
constexpr int kModes = 7;

std::vector<gl::Flag> flags(int mode, bool downsample, bool fade = false, bool resized = false) {
    return {{"MODE", mode}, {"DOWNSAMPLE", downsample}, {"FADE", fade}, {"RESIZED", fade && resized}};
}
}  // namespace

void Present::run(const Inputs& in, int width, int height, GLenum format, const Outputs& out) {
    out.image.ensure(width, height, format, "presented image");
    const gl::Framebuffer target = gl::makeFramebuffer("present", {out.image.get()});
    glBindFramebuffer(GL_FRAMEBUFFER, target.get());
    glViewport(0, 0, width, height);
    const GLuint program = shaders_.program("present", flags(static_cast<int>(in.mode), in.downsample, in.before != 0, in.resized));
    glUseProgram(program);
    gl::Uniforms(program)
        .set("u_image", 0)
        .set("u_scale", in.scale)
        .set("u_size", glm::ivec2(width, height))
        .set("u_depthImage", in.depthImage)
        .set("u_before", 1)
        .set("u_share", in.share);
    if (in.before) {
        glBindTextureUnit(1, in.before);
        glBindSampler(1, in.resized ? linear_.get() : 0);
    }
    glBindTextureUnit(0, in.image);
    glBindVertexArray(vertexArray_.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindSampler(1, 0);
}

void Present::warmUp() {
    for (int mode = 0; mode < kModes; ++mode) {
        shaders_.program("present", flags(mode, false));
        shaders_.program("present", flags(mode, true));
    }
    for (const bool resized : {false, true}) shaders_.program("present", flags(int(Mode::Picture), false, true, resized));
}

}  // namespace caustream::render
