#include "bench/accuracy/window.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "optics/colour.h"

namespace caustream::bench {

namespace {

std::size_t index(int value) { return static_cast<std::size_t>(value); }

}  // namespace

Window Window::onPlane(const scene::Light& light, const glm::dvec3& origin, const glm::dvec3& u, const glm::dvec3& v, int cells) {
    Window window;
    window.cells_ = cells;
    window.light_ = light.position;
    window.origin_ = origin, window.u_ = u, window.v_ = v;
    window.directional_ = light.type == scene::LightType::Directional;
    const glm::dvec3 normal = glm::normalize(glm::cross(u, v));
    for (int j = 0; j < cells; ++j) {
        for (int i = 0; i < cells; ++i) {
            const glm::dvec3 to = glm::dvec3(light.position) - window.at(i + 0.5, j + 0.5);
            const double r = glm::length(to);
            window.weights_.push_back(window.directional_ ? std::abs(glm::dot(normal, glm::dvec3(light.direction)))
                                                          : std::abs(glm::dot(normal, to)) / (r * r * r));
        }
    }
    return window;
}

Window Window::ofView(const scene::Light& light, const glm::dmat4& worldToClip, int cells) {
    Window window;
    window.plane_ = false;
    window.cells_ = cells;
    window.light_ = light.position;
    window.directional_ = light.type == scene::LightType::Directional;
    window.toClip_ = worldToClip;
    window.toWorld_ = glm::inverse(worldToClip);
    double sum = 0.0;
    for (int j = 0; j < cells; ++j) {
        for (int i = 0; i < cells; ++i) {
            // Points at unit distance: the parallelogram of their differences is the cell's solid angle (or area).
            const glm::dvec3 across = window.at(i + 1.0, j + 0.5) - window.at(i, j + 0.5);
            const glm::dvec3 along = window.at(i + 0.5, j + 1.0) - window.at(i + 0.5, j);
            window.weights_.push_back(glm::length(glm::cross(across, along)));
            sum += window.weights_.back();
        }
    }
    for (double& weight : window.weights_) weight *= static_cast<double>(cells) * cells / sum;
    return window;
}

glm::dvec3 Window::at(double x, double y) const {
    const double s = x / cells_, t = y / cells_;
    if (plane_) return origin_ + s * u_ + t * v_;
    const auto unproject = [&](double depth) {
        const glm::dvec4 p = toWorld_ * glm::dvec4(2.0 * s - 1.0, 2.0 * t - 1.0, depth, 1.0);
        return glm::dvec3(p) / p.w;
    };
    // Depth is reversed: 1 is near. Perspective: only the direction is taken from the matrix, which is of single precision.
    const glm::dvec3 near = unproject(1.0);
    if (directional_) return near;
    return light_ + glm::normalize(unproject(0.5) - near);
}

std::vector<float> resample(const render::Frame& frame, const Window& window, int samples) {
    assert(frame.sample == render::Sample::F32);
    std::vector<float> map(frame.pixels.size() / sizeof(float));
    std::memcpy(map.data(), frame.pixels.data(), map.size() * sizeof(float));
    const int cells = window.cells(), bands = frame.bands;
    const std::size_t area = index(cells) * index(cells);
    const glm::dmat4 toMap(frame.lightMatrix);
    const auto texel = [&](double x, double y) {
        const glm::dvec4 clip = toMap * glm::dvec4(window.at(x, y), 1.0);
        return clip.w > 0.0 ? glm::dvec2(0.5 + 0.5 * clip.x / clip.w, 0.5 + 0.5 * clip.y / clip.w) * glm::dvec2(frame.width, frame.height)
                            : glm::dvec2(-1.0);
    };
    // As many points as a cell has texels across, at the window's middle.
    const double middle = 0.5 * cells;
    const glm::dvec2 step = glm::abs(texel(middle + 0.5, middle + 0.5) - texel(middle - 0.5, middle - 0.5));
    samples = std::clamp(static_cast<int>(std::ceil(1.5 * std::max(step.x, step.y))), samples, 32);

    std::vector<double> sums(area * index(bands));
    for (int j = 0; j < cells * samples; ++j) {
        for (int i = 0; i < cells * samples; ++i) {
            const glm::dvec2 at = glm::floor(texel((i + 0.5) / samples, (j + 0.5) / samples));
            if (at.x < 0.0 || at.y < 0.0 || at.x >= frame.width || at.y >= frame.height) continue;
            const float* value = &map[(static_cast<std::size_t>(at.y) * index(frame.width) + static_cast<std::size_t>(at.x)) * index(bands)];
            const std::size_t cell = index(j / samples) * index(cells) + index(i / samples);
            for (int band = 0; band < bands; ++band) sums[index(band) * area + cell] += value[band];
        }
    }
    std::vector<float> values(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) values[i] = static_cast<float>(sums[i] * window.weights()[i % area] / (samples * samples));
    return values;
}

namespace {

void transform(std::vector<float>& bands, const glm::dmat3& matrix) {
    const std::size_t area = bands.size() / 3;
    for (std::size_t i = 0; i < area; ++i) {
        const glm::dvec3 to = matrix * glm::dvec3(bands[i], bands[area + i], bands[2 * area + i]);
        bands[i] = static_cast<float>(to.x), bands[area + i] = static_cast<float>(to.y), bands[2 * area + i] = static_cast<float>(to.z);
    }
}

// Concentration of each of BT.709's channels -> XYZ.
glm::dmat3 toXyz(const optics::Spectrum& light) {
    const glm::dvec3 rgb = optics::sampleWavelengths(7, light).lightRgb;
    return glm::inverse(optics::xyzToRgb()) * glm::dmat3(rgb.x, 0, 0, 0, rgb.y, 0, 0, 0, rgb.z);
}

}  // namespace

void rgbToXyz(std::vector<float>& bands, const optics::Spectrum& light) { transform(bands, toXyz(light)); }
void xyzToRgb(std::vector<float>& bands, const optics::Spectrum& light) { transform(bands, glm::inverse(toXyz(light))); }

}  // namespace caustream::bench
