#include "gl/names.h"

#include <array>
#include <string>

#include "error.h"

namespace caustream::gl {

namespace {
void label(GLenum kind, GLuint name, std::string_view text) {
    glObjectLabel(kind, name, static_cast<GLsizei>(text.size()), text.data());
}

GLuint createTexture() {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    return name;
}

GLuint createBuffer() {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    return name;
}
}  // namespace

Texture::Texture(int width, int height, GLenum format, std::string_view text, int levels)
    : GlName(createTexture()), width_(width), height_(height), levels_(levels), format_(format) {
    glTextureStorage2D(get(), levels, format, width, height);
    glTextureParameteri(get(), GL_TEXTURE_MIN_FILTER, levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST);
    glTextureParameteri(get(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTextureParameteri(get(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(get(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    label(GL_TEXTURE, get(), text);
}

bool Texture::ensure(int width, int height, GLenum format, std::string_view text, int levels) {
    if (*this && width == width_ && height == height_ && format == format_ && levels == levels_) return false;
    *this = Texture();  // free before taking: the peak is one, not two
    *this = Texture(width, height, format, text, levels);
    return true;
}

Buffer::Buffer(std::size_t bytes, const void* data, GLbitfield flags, std::string_view text)
    : GlName(createBuffer()), bytes_(bytes) {
    glNamedBufferStorage(get(), static_cast<GLsizeiptr>(bytes), data, flags);
    label(GL_BUFFER, get(), text);
}

bool Buffer::ensure(std::size_t bytes, GLbitfield flags, std::string_view text) {
    if (*this && bytes <= bytes_) return false;
    *this = Buffer();
    *this = Buffer(bytes, nullptr, flags, text);
    return true;
}

void BufferTexture::view(const Buffer& buffer, GLenum format) {
    if (!*this) {
        GLuint name = 0;
        glCreateTextures(GL_TEXTURE_BUFFER, 1, &name);
        GlName::operator=(GlName(name));
    }
    glTextureBuffer(get(), format, buffer.get());
}

Framebuffer makeFramebuffer(std::string_view text, std::initializer_list<GLuint> colors, GLuint depth) {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    Framebuffer framebuffer(name);
    label(GL_FRAMEBUFFER, name, text);
    std::array<GLenum, 8> draw{};
    GLsizei count = 0;
    for (GLuint color : colors) {
        glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT0 + count, color, 0);
        draw[count] = GL_COLOR_ATTACHMENT0 + count;
        ++count;
    }
    if (depth) glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, depth, 0);
    glNamedFramebufferDrawBuffers(name, count, draw.data());
    const GLenum status = glCheckNamedFramebufferStatus(name, GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        throw Error("framebuffer " + std::string(text) + " is incomplete (" + std::to_string(status) +
                    "); the GPU's driver does not render to this format: try --gpu software");
    }
    return framebuffer;
}

VertexArray makeVertexArray() {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    return VertexArray(name);
}

Query makeQuery(GLenum target) {
    GLuint name = 0;
    glCreateQueries(target, 1, &name);
    return Query(name);
}

TransformFeedback makeTransformFeedback() {
    GLuint name = 0;
    glCreateTransformFeedbacks(1, &name);
    return TransformFeedback(name);
}

Sampler makeSampler(GLenum filter, GLenum wrap, std::string_view text) {
    GLuint name = 0;
    glCreateSamplers(1, &name);
    const bool mipmapped = filter == GL_LINEAR_MIPMAP_LINEAR;
    glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(filter));
    glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER, mipmapped ? GL_LINEAR : static_cast<GLint>(filter));
    glSamplerParameteri(name, GL_TEXTURE_WRAP_S, static_cast<GLint>(wrap));
    glSamplerParameteri(name, GL_TEXTURE_WRAP_T, static_cast<GLint>(wrap));
    label(GL_SAMPLER, name, text);
    return Sampler(name);
}

Sampler makeShadowSampler(std::string_view text) {
    Sampler sampler = makeSampler(GL_LINEAR, GL_CLAMP_TO_EDGE, text);
    glSamplerParameteri(sampler.get(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glSamplerParameteri(sampler.get(), GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    return sampler;
}

}  // namespace caustream::gl
