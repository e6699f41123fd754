#include "bench/stability/small_change.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <limits>

namespace caustream::stability {

namespace {

constexpr int kSamples = 3;   // a side of a texel: two maps whose texels are turned against each other miss no focus

// Luminance at a place in texels, bilinear; 0 outside.
double luminanceAt(const MapImage& map, double x, double y) {
    if (!(x > -0.5 && y > -0.5 && x < map.size - 0.5 && y < map.size - 0.5)) return 0.0;
    const int left = static_cast<int>(std::floor(x)), low = static_cast<int>(std::floor(y));
    const double fx = x - left, fy = y - low;
    double sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        const int column = std::clamp(left + (i & 1), 0, map.size - 1), row = std::clamp(low + (i >> 1), 0, map.size - 1);
        const glm::vec4& texel = map.texels[static_cast<std::size_t>(row * map.size + column)];
        const double share = ((i & 1) ? fx : 1.0 - fx) * ((i >> 1) ? fy : 1.0 - fy);
        sum += share * (0.2126 * texel.r + 0.7152 * texel.g + 0.0722 * texel.b);
    }
    return sum;
}

// Solid angle of a texel of the view over that of its middle texel, at clip coordinates (x, y).
double extentAt(const glm::dmat4& worldToClip, double x, double y) {
    const auto row = [&](int i) { return glm::dvec3(worldToClip[0][i], worldToClip[1][i], worldToClip[2][i]); };
    if (glm::length(row(3)) == 0.0) return 1.0;
    const glm::dvec2 tangent(x / glm::length(row(0)), y / glm::length(row(1)));
    return std::pow(1.0 + glm::dot(tangent, tangent), -1.5);
}

double fluxOf(const MapImage& map) {
    double sum = 0.0;
    for (int i = 0; i < map.size * map.size; ++i) sum += luminanceAt(map, i % map.size, i / map.size);
    return sum;
}

}  // namespace

std::optional<scene::Scene> withLightMoved(scene::Scene scene, int index) {
    scene::Light& light = scene.lights[static_cast<std::size_t>(index)];
    const scene::Bounds& target = scene.geometry->casterBounds.empty() ? scene.geometry->bounds : scene.geometry->casterBounds;
    const glm::vec3 helper = std::abs(light.direction.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 axis = glm::normalize(glm::cross(light.direction, helper));
    const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), double(kLightStep), glm::dvec3(axis)));
    light.direction = glm::normalize(glm::vec3(turn * glm::dvec3(light.direction)));
    if (light.type == scene::LightType::Directional) return scene;
    const glm::dvec3 before(light.position), middle(target.centre()), from = before - middle;
    const double size = std::max(glm::length(from), double(target.radius()));
    // Across the beam; a light in the middle of the caster has to step out of it.
    const glm::dvec3 step = glm::length(from) > 1e-3 * size ? turn * from - from : double(kLightStep) * size * glm::cross(glm::dvec3(light.direction), glm::dvec3(axis));
    light.position = glm::vec3(before + step);
    const double farthest = std::max(glm::length(middle), glm::length(before));
    return farthest * std::numeric_limits<float>::epsilon() < glm::length(step) ? std::optional(scene) : std::nullopt;
}

double changeBetween(const MapImage& a, const MapImage& b) {
    const double fluxA = a.size ? fluxOf(a) : 0.0, fluxB = b.size ? fluxOf(b) : 0.0;
    if (fluxA <= 0.0 || fluxB <= 0.0) return fluxA > 0.0 || fluxB > 0.0 ? 1.0 : 0.0;
    const glm::dmat4 fromA(a.worldToClip), toWorld = glm::inverse(fromA), toB(b.worldToClip);
    const int cells = (a.size + kCellTexels - 1) / kCellTexels + 1;
    std::vector<double> sumA(static_cast<std::size_t>(cells * cells)), sumB(sumA.size());
    for (int j = 0; j < a.size * kSamples; ++j) {
        for (int i = 0; i < a.size * kSamples; ++i) {
            const double x = (i + 0.5) / kSamples, y = (j + 0.5) / kSamples;
            // A map that does not say how far its receivers are (alpha 1) is compared as if they were far.
            const float alpha = a.texels[static_cast<std::size_t>(j / kSamples * a.size + i / kSamples)].a;
            const double layer = alpha < 1.0f ? alpha : 0.0f;
            const glm::dvec2 clip(2.0 * x / a.size - 1.0, 2.0 * y / a.size - 1.0);
            const glm::dvec4 inB = toB * (toWorld * glm::dvec4(clip, layer, 1.0));
            const double extent = extentAt(fromA, clip.x, clip.y);
            const double fromHere = extent * luminanceAt(a, x - 0.5, y - 0.5);
            const double fromThere = extent * luminanceAt(b, (0.5 + 0.5 * inB.x / inB.w) * b.size - 0.5, (0.5 + 0.5 * inB.y / inB.w) * b.size - 0.5);
            const double cellX = x / kCellTexels, cellY = y / kCellTexels;
            const int column = static_cast<int>(cellX), row = static_cast<int>(cellY);
            for (int k = 0; k < 4; ++k) {
                const double share = ((k & 1) ? cellX - column : 1.0 - cellX + column) * ((k >> 1) ? cellY - row : 1.0 - cellY + row);
                const auto cell = static_cast<std::size_t>((row + (k >> 1)) * cells + column + (k & 1));
                sumA[cell] += share * fromHere, sumB[cell] += share * fromThere;
            }
        }
    }
    double difference = 0.0, total = 0.0;
    for (std::size_t i = 0; i < sumA.size(); ++i) difference += std::abs(sumA[i] - sumB[i]), total += std::abs(sumA[i]);
    return difference / total;
}

}  // namespace caustream::stability
