#include "bench/reference/collector.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace caustream::tracer {

namespace {

std::size_t cellsOf(const Window& window) { return static_cast<std::size_t>(window.columns) * static_cast<std::size_t>(window.rows); }
std::size_t cellsOf(const MapView& map) { return static_cast<std::size_t>(map.size) * static_cast<std::size_t>(map.size); }

glm::dvec3 row(const glm::dmat4& m, int r) { return {m[0][r], m[1][r], m[2][r]}; }

// Mean of two halves per cell, over what each cell is (m^2, sr).
Image merge(const std::vector<double>& a, const std::vector<double>& b, int columns, int rows, const std::vector<double>& extents) {
    const std::size_t cells = extents.size();
    Image image{.columns = columns, .rows = rows, .channels = static_cast<int>(a.size() / cells), .values = std::vector<float>(a.size())};
    for (std::size_t first = 0; first < a.size(); first += cells) {
        double apart = 0.0, sum = 0.0;
        for (std::size_t i = 0; i < cells; ++i) {
            const double x = a[first + i], y = b[first + i];
            apart += std::abs(x - y), sum += x + y;
            image.values[first + i] = static_cast<float>(0.5 * (x + y) / extents[i]);
        }
        image.relativeL1.push_back(sum > 0.0 ? apart / sum : 0.0);
    }
    return image;
}

}  // namespace

Collector::Collector(const World& world, const Settings& settings, const Surfaces& surfaces)
    : settings_(settings), surfaces_(surfaces), light_(world.light) {
    const auto sums = [&](std::size_t cells) {
        return Sums{std::vector<double>(cells * settings.wavelengthsNm.size()),
                    std::vector<double>(settings.continuousSamples > 0 ? 3 * cells : 0)};
    };
    for (const Window& window : settings.windows) {
        frames_.push_back({glm::normalize(glm::cross(window.u, window.v)), window.u / glm::dot(window.u, window.u), window.v / glm::dot(window.v, window.v)});
        windows_.push_back(sums(cellsOf(window)));
    }
    for (const MapView& map : settings.maps) maps_.push_back(sums(cellsOf(map)));
}

void Collector::add(Sums& sums, std::size_t cells, std::size_t cell, const Carried& carried, double flux) const {
    if (carried.band >= 0) {
        sums.bands[static_cast<std::size_t>(carried.band) * cells + cell] += flux;
        return;
    }
    for (int i = 0; i < 3; ++i) sums.xyz[static_cast<std::size_t>(i) * cells + cell] += flux * carried.xyz[i];
}

// The receiver's lit side, and nothing opaque before it. Glass does not hide: its receivers are in the map all the same.
bool Collector::lightSees(const glm::dvec3& point, const glm::dvec3& direction, const glm::dvec3& normal) const {
    const bool directional = light_.type == scene::LightType::Directional;
    const glm::dvec3 lit = directional ? light_.direction : point - light_.position;
    if (glm::dot(lit, normal) * glm::dot(direction, normal) <= 0.0) return false;
    return !surfaces_.receiverBetween(directional ? point - surfaces_.reach() * light_.direction : light_.position, point);
}

void Collector::land(const glm::dvec3& point, const glm::dvec3& direction, const glm::dvec3& normal, const Carried& carried, double flux) {
    for (std::size_t i = 0; i < windows_.size(); ++i) {
        const Window& window = settings_.windows[i];
        const glm::dvec3 from = point - window.origin;
        if (std::abs(glm::dot(from, frames_[i].normal)) > window.toleranceM) continue;
        const double column = std::floor(glm::dot(from, frames_[i].u) * window.columns), line = std::floor(glm::dot(from, frames_[i].v) * window.rows);
        if (column < 0.0 || line < 0.0 || column >= window.columns || line >= window.rows) continue;
        const auto cell = static_cast<std::size_t>(line) * static_cast<std::size_t>(window.columns) + static_cast<std::size_t>(column);
        add(windows_[i], cellsOf(window), cell, carried, flux);
    }
    for (std::size_t i = 0; i < maps_.size(); ++i) {
        const MapView& map = settings_.maps[i];
        const glm::dvec4 clip = map.worldToClip * glm::dvec4(point, 1.0);
        if (clip.w <= 0.0) continue;
        const double column = std::floor((0.5 + 0.5 * clip.x / clip.w) * map.size), line = std::floor((0.5 + 0.5 * clip.y / clip.w) * map.size);
        if (!(column >= 0.0 && line >= 0.0 && column < map.size && line < map.size)) continue;
        if (!lightSees(point, direction, normal)) {
            // The mean of the wavelengths; of the spectrum only where there are none.
            if (carried.band >= 0) maps_[i].hidden += flux / static_cast<double>(settings_.wavelengthsNm.size());
            else if (settings_.wavelengthsNm.empty()) maps_[i].hidden += flux * carried.share;
            continue;
        }
        add(maps_[i], cellsOf(map), static_cast<std::size_t>(line) * static_cast<std::size_t>(map.size) + static_cast<std::size_t>(column), carried, flux);
    }
}

// Solid angle of each texel (area for a directional light). The view is unsheared: the lengths of the matrix's rows tell
// the tangents of its half angles.
std::vector<double> Collector::extents(const MapView& map) const {
    const double halfX = 1.0 / glm::length(row(map.worldToClip, 0)), halfY = 1.0 / glm::length(row(map.worldToClip, 1));
    std::vector<double> extents(cellsOf(map), 4.0 * halfX * halfY / (static_cast<double>(map.size) * map.size));
    if (light_.type == scene::LightType::Directional) return extents;
    const double scale = glm::length(row(map.worldToClip, 3));
    const auto edge = [&](int i, double half) { return (2.0 * i / map.size - 1.0) * half * scale; };
    // Solid angle of a rectangle from the point above its corner's foot.
    const auto corner = [](double x, double y) { return std::atan(x * y / std::sqrt(1.0 + x * x + y * y)); };
    for (int j = 0; j < map.size; ++j) {
        for (int i = 0; i < map.size; ++i) {
            const double x0 = edge(i, halfX), x1 = edge(i + 1, halfX), y0 = edge(j, halfY), y1 = edge(j + 1, halfY);
            extents[static_cast<std::size_t>(j) * static_cast<std::size_t>(map.size) + static_cast<std::size_t>(i)] =
                corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0);
        }
    }
    return extents;
}

void Collector::finish(const Collector& a, const Collector& b, Result& result) {
    const Settings& settings = a.settings_;
    const auto collect = [](const Sums& x, const Sums& y, int columns, int rows, const std::vector<double>& extents) {
        return Collected{merge(x.bands, y.bands, columns, rows, extents), merge(x.xyz, y.xyz, columns, rows, extents)};
    };
    for (std::size_t i = 0; i < settings.windows.size(); ++i) {
        const Window& window = settings.windows[i];
        const double area = glm::length(glm::cross(window.u, window.v)) / static_cast<double>(cellsOf(window));
        result.windows.push_back(collect(a.windows_[i], b.windows_[i], window.columns, window.rows, std::vector<double>(cellsOf(window), area)));
    }
    for (std::size_t i = 0; i < settings.maps.size(); ++i) {
        const int size = settings.maps[i].size;
        result.maps.push_back(collect(a.maps_[i], b.maps_[i], size, size, a.extents(settings.maps[i])));
        result.hidden.push_back(0.5 * (a.maps_[i].hidden + b.maps_[i].hidden));
    }
}

}  // namespace caustream::tracer
