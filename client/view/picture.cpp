#include "client/view/picture.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

namespace caustream::view {
namespace {

// One triangle that covers the viewport; row 0 of the texture is the picture's top.
constexpr const char* kVertexShader = R"(#version 330 core
out vec2 v_uv;
void main() {
    vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
    v_uv = vec2(corner.x, 1.0 - corner.y);
    gl_Position = vec4(2.0 * corner - 1.0, 0.0, 1.0);
})";

// u_white 0: the bytes are sRGB. Otherwise linear values: divided by it, then IEC 61966-2-1.
constexpr const char* kFragmentShader = R"(#version 330 core
uniform sampler2D u_picture;
uniform float u_white;
in vec2 v_uv;
out vec4 o_color;
void main() {
    vec3 color = texture(u_picture, v_uv).rgb;
    if (u_white > 0.0) {
        color = clamp(color / u_white, 0.0, 1.0);
        color = mix(12.92 * color, 1.055 * pow(color, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, color));
    }
    o_color = vec4(color, 1.0);
})";

unsigned compile(unsigned kind, const char* source) {
    const unsigned shader = glCreateShader(kind);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    int good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (!good) {
        char log[512] = "";
        glGetShaderInfoLog(shader, sizeof log, nullptr, log);
        throw std::runtime_error(std::string("the picture's shader does not compile: ") + log +
                                 "; update the GPU's driver");
    }
    return shader;
}

// Of every 13th texel: enough to set a brightness by, and quick.
float sparseWhite(const connection::Image& image) {
    constexpr std::size_t kStep = 13;
    const std::size_t bands = static_cast<std::size_t>(image.bands), size = protocol::sampleBytes(image.sample);
    connection::Image sparse{0, 1, image.bands, image.sample, image.scale, {}};
    for (std::size_t i = 0; (i + 1) * bands <= image.samples(); i += kStep) {
        const auto* texel = &image.data[i * bands * size];
        sparse.data.insert(sparse.data.end(), texel, texel + bands * size);
        ++sparse.width;
    }
    return connection::whiteLevel(connection::toFloats(sparse), image.bands) / image.scale;
}

}  // namespace

Picture::Picture() {
    const unsigned vertex = compile(GL_VERTEX_SHADER, kVertexShader),
                   fragment = compile(GL_FRAGMENT_SHADER, kFragmentShader);
    program_ = glCreateProgram();
    glAttachShader(program_, vertex);
    glAttachShader(program_, fragment);
    glLinkProgram(program_);
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    glGenVertexArrays(1, &vertexArray_);
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    for (const unsigned filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
    for (const unsigned wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
}

Picture::~Picture() {
    glDeleteTextures(1, &texture_);
    glDeleteVertexArrays(1, &vertexArray_);
    glDeleteProgram(program_);
}

void Picture::set(const connection::Image& image, int viewWidth, int viewHeight) {
    viewWidth_ = std::max(viewWidth, 1);
    viewHeight_ = std::max(viewHeight, 1);
    if (image.bands == 3 || image.bands == 1)
        upload(image);
    else
        upload(connection::toPicture(image));
}

void Picture::upload(const connection::Image& image) {
    using protocol::Sample;
    const int format = image.bands == 3 ? GL_RGB : GL_RED;
    const int type = image.sample == Sample::U8    ? GL_UNSIGNED_BYTE
                     : image.sample == Sample::F16 ? GL_HALF_FLOAT
                                                   : GL_FLOAT;
    const int sample = static_cast<int>(image.sample) * 4 + image.bands;
    white_ = image.sample == Sample::U8 ? 0.0f : sparseWhite(image);

    glBindTexture(GL_TEXTURE_2D, texture_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (width_ == image.width && height_ == image.height && sample_ == sample) {
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, static_cast<unsigned>(format),
                        static_cast<unsigned>(type), image.data.data());
        return;
    }
    width_ = image.width;
    height_ = image.height;
    sample_ = sample;
    const int internal = image.sample == Sample::U8 ? GL_RGB8 : GL_RGB16F;
    glTexImage2D(GL_TEXTURE_2D, 0, internal, width_, height_, 0, static_cast<unsigned>(format),
                 static_cast<unsigned>(type), image.data.data());
    // One band is shown as grey.
    const int swizzle[] = {GL_RED, image.bands == 3 ? GL_GREEN : GL_RED, image.bands == 3 ? GL_BLUE : GL_RED, GL_ONE};
    glTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_RGBA, swizzle);
}

Rectangle Picture::fit(const Rectangle& area) const {
    if (empty()) return area;
    const double scale =
        std::min(static_cast<double>(area.width) / viewWidth_, static_cast<double>(area.height) / viewHeight_);
    const int width = static_cast<int>(std::lround(viewWidth_ * scale)),
              height = static_cast<int>(std::lround(viewHeight_ * scale));
    return {area.x + (area.width - width) / 2, area.y + (area.height - height) / 2, width, height};
}

void Picture::draw(const Rectangle& area) const {
    if (empty()) return;
    const Rectangle place = fit(area);
    glViewport(place.x, place.y, place.width, place.height);
    glDisable(GL_BLEND);
    glUseProgram(program_);
    glUniform1f(glGetUniformLocation(program_, "u_white"), white_);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glBindVertexArray(vertexArray_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace caustream::view
