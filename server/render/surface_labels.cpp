#include "render/surface_labels.h"

#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

namespace caustream::render {

namespace {

// Values of `channels` a texel, rows bottom to top.
std::vector<float> readFloats(const gl::Texture& image, GLenum format, std::size_t channels) {
    std::vector<float> values(channels * static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height()));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(image.get(), 0, format, GL_FLOAT, static_cast<GLsizei>(values.size() * sizeof(float)), values.data());
    return values;
}

// `bands` of each texel's channels, from `first` on, rows top to bottom.
void pack(const std::vector<float>& values, std::size_t channels, std::size_t first, int bands, Frame& frame) {
    frame.bands = bands;
    frame.sample = Sample::F32;
    const auto width = static_cast<std::size_t>(frame.width), height = static_cast<std::size_t>(frame.height);
    const std::size_t size = static_cast<std::size_t>(bands) * sizeof(float);
    frame.pixels.resize(width * height * size);
    std::uint8_t* to = frame.pixels.data();
    for (std::size_t y = height; y-- > 0;) {
        for (std::size_t x = 0; x < width; ++x, to += size) std::memcpy(to, &values[channels * (y * width + x) + first], size);
    }
}

}  // namespace

bool isLabel(const Request& request) {
    return request.target == Target::Pass && (request.pass == "depth" || request.pass == "normals" || request.pass == "caster_mask");
}

void SurfaceLabels::run(const Request& request, const GpuScene& gpu, const View& view, gl::StageTimer& timer, Present& present,
                        gl::Texture& output, Frame& frame) {
    timer.stage("first_surface", [&] {
        pass_.run({gpu, request.scene->materials, view, request.width, request.height}, {surface_, label_});
    });
    const bool mask = request.pass == "caster_mask", depth = request.pass == "depth";
    if (request.sample == Sample::U8) {
        Present::Inputs in{.image = mask ? label_.get() : surface_.get(), .mode = mask ? Present::Mode::Label : Present::Mode::Normals};
        if (depth) in.mode = Present::Mode::Distance, in.scale = glm::distance(request.camera.eye, request.camera.target);
        timer.stage("present", [&] { present.run(in, request.width, request.height, GL_RGBA8, {output}); });
        return;
    }
    frame.width = request.width, frame.height = request.height;
    timer.stage("read_back", [&] {
        if (mask) return pack(readFloats(label_, GL_RED, 1), 1, 0, 1, frame);
        std::vector<float> values = readFloats(surface_, GL_RGBA, 4);
        if (!depth) return pack(values, 4, 0, 3, frame);
        for (std::size_t i = 3; i < values.size(); i += 4) {
            if (values[i] == 0.0f) values[i] = std::numeric_limits<float>::infinity();
        }
        pack(values, 4, 3, 1, frame);
    });
}

}  // namespace caustream::render
