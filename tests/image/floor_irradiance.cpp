#include "tests/image/floor_irradiance.h"

#include <algorithm>
#include <cmath>

#include "bench/accuracy/window.h"
#include "bench/reference/tracer.h"

namespace caustream::image {

std::vector<float> floorIrradiance(const render::Frame& frame, const reference::Reference& reference, int samples) {
    scene::Light light;
    light.position = {reference.lightPosition[0], reference.lightPosition[1], reference.lightPosition[2]};
    const reference::Window& w = reference.window;
    return bench::resample(frame, bench::Window::onPlane(light, {w.x0, 0, w.z0}, {w.width, 0, 0}, {0, 0, w.width}, w.cells), samples);
}

Comparison compare(const std::vector<float>& irradiance, const reference::Reference& reference) {
    const int cells = reference.window.cells;
    const std::size_t area = static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells), bands = reference.nm.size();
    Comparison result;
    for (std::size_t band = 0; band < bands; ++band) {
        const tracer::Difference d = tracer::difference(&irradiance[band * area], &reference.mono7.values[band * area], cells, cells);
        result.relativeL1 += d.relativeL1 / static_cast<double>(bands);
        result.fluxRatio += d.fluxRatio / static_cast<double>(bands);
        if (std::abs(d.fluxRatio - 1.0) > std::abs(result.worstFluxRatio - 1.0)) result.worstFluxRatio = d.fluxRatio;
        result.worstCentroidCells = std::max(result.worstCentroidCells, d.centroidCells);
    }
    return result;
}

}  // namespace caustream::image
