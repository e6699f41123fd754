#include "tests/image/floor_irradiance.h"

#include <cmath>
#include <cstring>
#include <glm/vec4.hpp>

namespace caustream::image {

std::vector<float> floorIrradiance(const render::Frame& frame, const reference::Reference& reference, int samples) {
    const auto& window = reference.window;
    const int cells = window.cells, bands = frame.bands;
    const std::size_t area = static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells);
    std::vector<float> map(frame.pixels.size() / sizeof(float));
    std::memcpy(map.data(), frame.pixels.data(), map.size() * sizeof(float));
    std::vector<double> sums(area * static_cast<std::size_t>(bands));
    const glm::dmat4 toMap(frame.lightMatrix);
    const auto& light = reference.lightPosition;
    for (int j = 0; j < cells * samples; ++j) {
        for (int i = 0; i < cells * samples; ++i) {
            const double x = window.x0 + (i + 0.5) * window.width / (cells * samples);
            const double z = window.z0 + (j + 0.5) * window.width / (cells * samples);
            const glm::dvec4 clip = toMap * glm::dvec4(x, 0.0, z, 1.0);
            const int column = static_cast<int>(std::floor((0.5 + 0.5 * clip.x / clip.w) * frame.width));
            const int row = static_cast<int>(std::floor((0.5 + 0.5 * clip.y / clip.w) * frame.height));
            if (clip.w <= 0.0 || column < 0 || row < 0 || column >= frame.width || row >= frame.height) continue;
            const double dx = x - light[0], dy = light[1], dz = z - light[2], r2 = dx * dx + dy * dy + dz * dz;
            const double direct = dy / (r2 * std::sqrt(r2));
            const std::size_t cell = static_cast<std::size_t>(j / samples) * static_cast<std::size_t>(cells) + static_cast<std::size_t>(i / samples);
            const float* texel = &map[(static_cast<std::size_t>(row) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(column)) * static_cast<std::size_t>(bands)];
            for (int band = 0; band < bands; ++band) sums[static_cast<std::size_t>(band) * area + cell] += texel[band] * direct;
        }
    }
    std::vector<float> irradiance(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) irradiance[i] = static_cast<float>(sums[i] / (samples * samples));
    return irradiance;
}

Comparison compare(const std::vector<float>& irradiance, const reference::Reference& reference) {
    const std::size_t cells = static_cast<std::size_t>(reference.window.cells), area = cells * cells;
    const std::size_t bands = reference.nm.size();
    Comparison result;
    for (std::size_t band = 0; band < bands; ++band) {
        double difference = 0, sumA = 0, sumB = 0, xA = 0, yA = 0, xB = 0, yB = 0;
        for (std::size_t cell = 0; cell < area; ++cell) {
            const double a = irradiance[band * area + cell], b = reference.mono7.values[band * area + cell];
            const double x = static_cast<double>(cell % cells), y = static_cast<double>(cell / cells);
            difference += std::abs(a - b);
            sumA += a, xA += a * x, yA += a * y;
            sumB += b, xB += b * x, yB += b * y;
        }
        result.relativeL1 += difference / sumB / static_cast<double>(bands);
        result.fluxRatio += sumA / sumB / static_cast<double>(bands);
        if (std::abs(sumA / sumB - 1.0) > std::abs(result.worstFluxRatio - 1.0)) result.worstFluxRatio = sumA / sumB;
        result.worstCentroidCells = std::max(result.worstCentroidCells, std::hypot(xA / sumA - xB / sumB, yA / sumA - yB / sumB));
    }
    return result;
}

}  // namespace caustream::image
