#include "render/passes/picture_mean.h"

#include "gl/uniforms.h"

namespace caustream::render {

namespace {
constexpr int kGroup = 8;   // pixels a side, as the shader says
}

void PictureMean::run(const gl::Texture& sample, float share, gl::Texture& mean) {
    mean.ensure(sample.width(), sample.height(), GL_RGBA32F, "mean picture");
    const GLuint program = shaders_.program("picture_mean");
    glUseProgram(program);
    gl::Uniforms(program).set("u_sample", 0).set("u_share", share);
    glBindTextureUnit(0, sample.get());
    glBindImageTexture(0, mean.get(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32F);
    const auto groups = [](int pixels) { return static_cast<GLuint>((pixels + kGroup - 1) / kGroup); };
    glDispatchCompute(groups(mean.width()), groups(mean.height()), 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);   // mean -> present, the next sample
    glBindImageTexture(0, 0, 0, GL_FALSE, 0, GL_READ_ONLY, GL_RGBA32F);
}

}  // namespace caustream::render
