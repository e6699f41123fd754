#include "render/enclosure.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace caustream::render {

Enclosure::Enclosure(const scene::Geometry& geometry)
    : first_(geometry.objects.data()), tolerance_(1e-5f * geometry.bounds.radius()) {
    for (const scene::Object& object : geometry.objects) {
        Plane& plane = planes_.emplace_back();
        // The plane of its first triangle with an area, if all of it lies there
        for (std::uint32_t i = 0; i + 2 < object.indexCount && !plane.flat; i += 3) {
            const auto corner = [&](std::uint32_t k) { return geometry.vertices[geometry.indices[object.firstIndex + i + k]].position; };
            const glm::vec3 across = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
            if (glm::dot(across, across) > 0.0f) plane = {true, corner(0), glm::normalize(across)};
        }
        const auto height = [&](const glm::vec3& point) { return glm::dot(point - plane.point, plane.normal); };
        for (std::uint32_t i = 0; i < object.indexCount && plane.flat; ++i) {
            plane.flat = std::abs(height(geometry.vertices[geometry.indices[object.firstIndex + i]].position)) <= tolerance_;
        }
        if (!plane.flat) continue;
        for (const scene::Object& other : geometry.objects) {
            if (&other == &object) continue;
            for (int k = 0; k < 8; ++k) {
                const scene::Bounds& box = other.bounds;
                const float at = height({k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z});
                plane.low = std::min(plane.low, at), plane.high = std::max(plane.high, at);
            }
        }
    }
}

bool Enclosure::shades(const scene::Object& object, const scene::Light& light) const {
    const Plane& plane = planes_[static_cast<std::size_t>(&object - first_)];
    if (!plane.flat) return true;
    const bool parallel = light.type == scene::LightType::Directional;
    const float side = glm::dot(parallel ? -light.direction : light.position - plane.point, plane.normal);
    const float least = parallel ? 1e-5f : tolerance_;
    return !((side > least && plane.low >= -tolerance_) || (side < -least && plane.high <= tolerance_));
}

}  // namespace caustream::render
