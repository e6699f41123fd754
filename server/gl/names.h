// Move-only owners of GL objects, made with direct state access. The context must outlive them.
#pragma once
#include <epoxy/gl.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace caustream::gl {

// How many GL objects there are, of every context together: one that only grows is a leak. Any thread may read it.
inline std::atomic<std::int64_t> liveObjects{0};

// Owns one GL name; Delete frees it.
template <void (*Delete)(GLuint)>
class GlName {
   public:
    GlName() = default;
    explicit GlName(GLuint name) : name_(name) { liveObjects += name_ != 0; }
    GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    GlName& operator=(GlName&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    ~GlName() {
        if (!name_) return;
        Delete(name_);
        --liveObjects;
    }
    GLuint get() const { return name_; }
    explicit operator bool() const { return name_ != 0; }

   private:
    GLuint name_ = 0;
};

inline void deleteTexture(GLuint n) { glDeleteTextures(1, &n); }
inline void deleteBuffer(GLuint n) { glDeleteBuffers(1, &n); }
inline void deleteFramebuffer(GLuint n) { glDeleteFramebuffers(1, &n); }
inline void deleteVertexArray(GLuint n) { glDeleteVertexArrays(1, &n); }
inline void deleteSampler(GLuint n) { glDeleteSamplers(1, &n); }
inline void deleteProgram(GLuint n) { glDeleteProgram(n); }
inline void deleteShader(GLuint n) { glDeleteShader(n); }
inline void deleteQuery(GLuint n) { glDeleteQueries(1, &n); }
inline void deleteTransformFeedback(GLuint n) { glDeleteTransformFeedbacks(1, &n); }

using Framebuffer = GlName<deleteFramebuffer>;
using VertexArray = GlName<deleteVertexArray>;
using Sampler = GlName<deleteSampler>;
using Program = GlName<deleteProgram>;
using Shader = GlName<deleteShader>;
using Query = GlName<deleteQuery>;
using TransformFeedback = GlName<deleteTransformFeedback>;

// 2D texture with immutable storage. Filtering and wrapping are the samplers' business, except that a fresh texture is
// nearest and clamped, so that it is complete with one level.
class Texture : public GlName<deleteTexture> {
   public:
    Texture() = default;
    Texture(int width, int height, GLenum format, std::string_view label, int levels = 1);
    // Makes it again only when size, format or levels differ; contents are then undefined. True if it did.
    bool ensure(int width, int height, GLenum format, std::string_view label, int levels = 1);
    int width() const { return width_; }
    int height() const { return height_; }
    GLenum format() const { return format_; }

   private:
    int width_ = 0, height_ = 0, levels_ = 0;
    GLenum format_ = 0;
};

// Buffer with immutable storage.
class Buffer : public GlName<deleteBuffer> {
   public:
    Buffer() = default;
    Buffer(std::size_t bytes, const void* data, GLbitfield flags, std::string_view label);
    // Grows (never shrinks) to at least `bytes`; contents are then undefined. True if it did.
    bool ensure(std::size_t bytes, GLbitfield flags, std::string_view label);
    std::size_t bytes() const { return bytes_; }

   private:
    std::size_t bytes_ = 0;
};

// A buffer's contents as a one-dimensional texture.
class BufferTexture : public GlName<deleteTexture> {
   public:
    // Reads `buffer` as texels of `format` from now on; the buffer must outlive the use.
    void view(const Buffer& buffer, GLenum format);
};

// Framebuffer over colour attachments and an optional depth attachment; throws Error when incomplete.
Framebuffer makeFramebuffer(std::string_view label, std::initializer_list<GLuint> colors, GLuint depth = 0);
// Empty: draws that need no vertex data need one bound all the same.
VertexArray makeVertexArray();
Query makeQuery(GLenum target);
TransformFeedback makeTransformFeedback();
Sampler makeSampler(GLenum filter, GLenum wrap, std::string_view label);
// Hardware depth comparison (LESS or EQUAL), linear: one fetch is a 2x2 percentage-closer filter.
Sampler makeShadowSampler(std::string_view label);

}  // namespace caustream::gl
