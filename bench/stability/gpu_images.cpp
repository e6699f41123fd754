#include "bench/stability/gpu_images.h"

#include <epoxy/gl.h>

#include <cmath>
#include <cstring>

namespace caustream::stability {

namespace {

// Some drivers count names up, others hand out the lowest free one: none lies far beyond the next.
GLuint namesEnd() {
    GLuint next = 0;
    glGenTextures(1, &next);
    glDeleteTextures(1, &next);
    return next + 4096;
}

GLint levelParameter(GLuint texture, GLint level, GLenum name) {
    GLint value = 0;
    glGetTextureLevelParameteriv(texture, level, name, &value);
    return value;
}

// A buffer's view is a texture too, but has no parameters of its own: asking for them is an error.
bool isPicture(GLuint texture) { return levelParameter(texture, 0, GL_TEXTURE_BUFFER_DATA_STORE_BINDING) == 0; }

std::string labelOf(GLuint texture) {
    GLchar text[256] = {};
    glGetObjectLabel(GL_TEXTURE, texture, sizeof text, nullptr, text);
    return text;
}

std::vector<float> readLevel(GLuint texture, GLint level, bool depth) {
    const auto width = static_cast<std::size_t>(levelParameter(texture, level, GL_TEXTURE_WIDTH));
    const auto height = static_cast<std::size_t>(levelParameter(texture, level, GL_TEXTURE_HEIGHT));
    const auto layers = static_cast<std::size_t>(levelParameter(texture, level, GL_TEXTURE_DEPTH));
    std::vector<float> values(width * height * layers * (depth ? 1 : 4));
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glGetTextureImage(texture, level, depth ? GL_DEPTH_COMPONENT : GL_RGBA, GL_FLOAT,
                      static_cast<GLsizei>(values.size() * sizeof(float)), values.data());
    return values;
}

}  // namespace

std::vector<GpuImage> readGpuImages() {
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);   // any pass -> read-back
    std::vector<GpuImage> images;
    for (GLuint name = 1, end = namesEnd(); name < end; ++name) {
        if (!glIsTexture(name) || !isPicture(name)) continue;
        const bool depth = levelParameter(name, 0, GL_TEXTURE_DEPTH_TYPE) == GL_FLOAT;
        if (!depth && levelParameter(name, 0, GL_TEXTURE_RED_TYPE) != GL_FLOAT) continue;
        GpuImage image{name, labelOf(name), levelParameter(name, 0, GL_TEXTURE_WIDTH), levelParameter(name, 0, GL_TEXTURE_HEIGHT), depth};
        image.hash = 0xcbf29ce484222325ull;
        GLint levels = 1;
        glGetTextureParameteriv(name, GL_TEXTURE_IMMUTABLE_LEVELS, &levels);
        for (GLint level = 0; level < levels; ++level) {
            for (const float value : readLevel(name, level, depth)) {
                std::uint32_t bits = 0;
                std::memcpy(&bits, &value, sizeof bits);
                image.hash = (image.hash ^ bits) * 0x100000001b3ull;
                image.notFinite += !std::isfinite(value);
            }
        }
        images.push_back(std::move(image));
    }
    return images;
}

std::vector<glm::vec4> readTexels(const GpuImage& image) {
    const std::vector<float> values = readLevel(image.name, 0, false);
    std::vector<glm::vec4> texels(values.size() / 4);
    std::memcpy(texels.data(), values.data(), texels.size() * sizeof(glm::vec4));
    return texels;
}

std::vector<unsigned> takeGlErrors() {
    std::vector<unsigned> errors;
    for (GLenum error = glGetError(); error != GL_NO_ERROR && errors.size() < 16; error = glGetError()) errors.push_back(error);
    return errors;
}

}  // namespace caustream::stability
