#include "render/passes/mean_luminance.h"

#include <numeric>
#include <vector>

#include "gl/uniforms.h"

namespace caustream::render {

namespace {
constexpr int kGroup = 32;   // columns, as the shader says
}

double MeanLuminance::of(const gl::Texture& image, float scale) {
    sums_.ensure(static_cast<std::size_t>(image.width()) * sizeof(float), 0, "column sums");
    const GLuint program = shaders_.program("mean_luminance");
    glUseProgram(program);
    gl::Uniforms(program).set("u_image", 0).set("u_scale", scale);
    glBindTextureUnit(0, image.get());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, sums_.get());
    glDispatchCompute(static_cast<GLuint>((image.width() + kGroup - 1) / kGroup), 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);   // sums -> read-back
    std::vector<float> sums(static_cast<std::size_t>(image.width()));
    glGetNamedBufferSubData(sums_.get(), 0, static_cast<GLsizeiptr>(sums.size() * sizeof(float)), sums.data());
    return std::accumulate(sums.begin(), sums.end(), 0.0) / (static_cast<double>(image.width()) * image.height());
}

}  // namespace caustream::render
