#include "render/map_energy.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace caustream::render {

std::vector<glm::vec4> readTexels(const gl::Texture& image) {
    std::vector<glm::vec4> texels(static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height()));
    glGetTextureImage(image.get(), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(texels.size() * sizeof(glm::vec4)), texels.data());
    return texels;
}

std::vector<GLuint> readWords(const gl::Buffer& buffer, std::size_t count) {
    std::vector<GLuint> words(count);
    glGetNamedBufferSubData(buffer.get(), 0, static_cast<GLsizeiptr>(count * sizeof(GLuint)), words.data());
    return words;
}

std::uint64_t fnv1a(std::uint64_t hash, const std::vector<GLuint>& words) {
    for (const GLuint word : words) hash = (hash ^ word) * 0x100000001b3ull;
    return hash;
}

double texelExtent(const View& view, int size, int index) {
    const double hx = view.halfExtent.x, hy = view.halfExtent.y, area = 4.0 * hx * hy / (static_cast<double>(size) * size);
    if (!view.perspective) return area;
    const double x = ((index % size + 0.5) * 2.0 / size - 1.0) * hx, y = ((index / size + 0.5) * 2.0 / size - 1.0) * hy;
    const double r2 = 1.0 + x * x + y * y;
    return area / (r2 * std::sqrt(r2));
}

double mapFlux(const gl::Texture& concentration, const View& view) {
    const std::vector<glm::vec4> texels = readTexels(concentration);
    double flux = 0.0;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        flux += glm::dot(glm::vec3(texels[i]), glm::vec3(0.2126f, 0.7152f, 0.0722f)) *
                texelExtent(view, concentration.width(), static_cast<int>(i));
    }
    return flux;
}

}  // namespace caustream::render
