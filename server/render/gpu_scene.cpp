#include "render/gpu_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace caustream::render {

namespace {
gl::Texture upload(const scene::Texture& texture) {
    const int levels = 1 + static_cast<int>(std::log2(std::max(texture.width, texture.height)));
    gl::Texture out(texture.width, texture.height, GL_SRGB8_ALPHA8, "scene texture", levels);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage2D(out.get(), 0, 0, 0, texture.width, texture.height, GL_RGBA, GL_UNSIGNED_BYTE,
                        texture.rgba.data());
    glGenerateTextureMipmap(out.get());
    return out;
}
}  // namespace

GpuScene::GpuScene(std::shared_ptr<const scene::Geometry> geometry)
    : geometry_(std::move(geometry)), vertexArray_(gl::makeVertexArray()) {
    const auto& vertices = geometry_->vertices;
    const auto& indices = geometry_->indices;
    vertices_ = gl::Buffer(std::max<std::size_t>(vertices.size(), 1) * sizeof(scene::Vertex),
                           vertices.empty() ? nullptr : vertices.data(), 0, "scene vertices");
    indices_ = gl::Buffer(std::max<std::size_t>(indices.size(), 1) * sizeof(std::uint32_t),
                          indices.empty() ? nullptr : indices.data(), 0, "scene indices");
    const GLuint array = vertexArray_.get();
    glVertexArrayVertexBuffer(array, 0, vertices_.get(), 0, sizeof(scene::Vertex));
    glVertexArrayElementBuffer(array, indices_.get());
    const struct {
        GLint size;
        std::size_t offset;
    } attributes[] = {{3, offsetof(scene::Vertex, position)},
                      {3, offsetof(scene::Vertex, normal)},
                      {2, offsetof(scene::Vertex, uv)}};
    for (GLuint i = 0; i < 3; ++i) {
        glEnableVertexArrayAttrib(array, i);
        glVertexArrayAttribFormat(array, i, attributes[i].size, GL_FLOAT, GL_FALSE,
                                  static_cast<GLuint>(attributes[i].offset));
        glVertexArrayAttribBinding(array, i, 0);
    }
    for (const scene::Texture& texture : geometry_->textures) textures_.push_back(upload(texture));
}

void GpuScene::draw(const scene::Object& object) const {
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(object.indexCount), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(object.firstIndex * sizeof(std::uint32_t)));
}

void GpuScene::drawWhere(const std::function<bool(const scene::Object&)>& wanted) const {
    for (const scene::Object& object : geometry_->objects) {
        if (wanted(object)) draw(object);
    }
}

}  // namespace caustream::render
