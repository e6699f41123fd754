// A scene's triangles and textures on the GPU, and the draws that every raster pass makes of them.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "gl/names.h"
#include "scene/scene.h"

namespace caustream::render {

class GpuScene {
   public:
    explicit GpuScene(std::shared_ptr<const scene::Geometry> geometry);

    // Vertex array: 0 position, 1 normal, 2 uv; index buffer bound. Bind it once per pass, then draw objects.
    void bind() const { glBindVertexArray(vertexArray_.get()); }
    void draw(const scene::Object& object) const;
    void drawWhere(const std::function<bool(const scene::Object&)>& wanted) const;

    const scene::Geometry& geometry() const { return *geometry_; }
    // sRGB textures with mip levels, in the order of Geometry::textures.
    GLuint texture(int index) const { return textures_[static_cast<std::size_t>(index)].get(); }

   private:
    std::shared_ptr<const scene::Geometry> geometry_;
    gl::Buffer vertices_, indices_;
    gl::VertexArray vertexArray_;
    std::vector<gl::Texture> textures_;
};

}  // namespace caustream::render
