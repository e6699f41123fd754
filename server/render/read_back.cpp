#include "render/read_back.h"

#include <cstring>
#include <glm/gtc/packing.hpp>

namespace caustream::render {

namespace {
// Rows of RGBA values -> RGB; drivers convert slowly, so the fourth channel is dropped here.
template <class T>
void dropAlpha(const std::vector<T>& rgba, std::vector<std::uint8_t>& out) {
    out.resize(rgba.size() / 4 * 3 * sizeof(T));
    std::uint8_t* to = out.data();
    for (std::size_t i = 0; i < rgba.size(); i += 4, to += 3 * sizeof(T)) std::memcpy(to, &rgba[i], 3 * sizeof(T));
}

template <class T>
std::vector<T> readTexels(const gl::Texture& image, GLenum type) {
    std::vector<T> texels(4 * static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height()));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(image.get(), 0, GL_RGBA, type, static_cast<GLsizei>(texels.size() * sizeof(T)), texels.data());
    return texels;
}
}  // namespace

void readImage(const gl::Texture& image, Sample sample, Frame& frame) {
    frame.width = image.width();
    frame.height = image.height();
    frame.bands = 3;
    frame.sample = sample;
    switch (sample) {
        case Sample::U8: return dropAlpha(readTexels<std::uint8_t>(image, GL_UNSIGNED_BYTE), frame.pixels);
        case Sample::F16: return dropAlpha(readTexels<std::uint16_t>(image, GL_HALF_FLOAT), frame.pixels);
        case Sample::F32: return dropAlpha(readTexels<float>(image, GL_FLOAT), frame.pixels);
    }
}

void readRgbx(const gl::Texture& image, Frame& frame) {
    frame.width = image.width();
    frame.height = image.height();
    frame.bands = 3;
    frame.sample = Sample::U8;
    frame.layout = PixelLayout::Rgbx;
    frame.pixels = readTexels<std::uint8_t>(image, GL_UNSIGNED_BYTE);
}

void readPlanes(const gl::Buffer& planes, PixelLayout layout, int width, int height, Frame& frame) {
    frame.width = width;
    frame.height = height;
    frame.bands = 3;
    frame.sample = Sample::U8;
    frame.layout = layout;
    frame.pixels.resize(planesOf(layout, width, height).bytes);
    glGetNamedBufferSubData(planes.get(), 0, static_cast<GLsizeiptr>(frame.pixels.size()), frame.pixels.data());
}

void packBands(const std::vector<float>& values, int size, int bands, Sample sample, Frame& frame) {
    frame.width = frame.height = size;
    frame.bands = bands;
    frame.sample = sample;
    const std::size_t count = static_cast<std::size_t>(size) * size * bands;
    if (sample == Sample::F32) {
        frame.pixels.assign(count * sizeof(float), 0);
        std::memcpy(frame.pixels.data(), values.data(), values.size() * sizeof(float));
        return;
    }
    frame.pixels.assign(count * sizeof(std::uint16_t), 0);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::uint16_t half = glm::packHalf1x16(values[i]);
        std::memcpy(&frame.pixels[i * sizeof half], &half, sizeof half);
    }
}

}  // namespace caustream::render
