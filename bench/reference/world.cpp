#include "bench/reference/world.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <unordered_map>

namespace caustream::tracer {

namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

// The vertices an object uses, and its triangles among them.
Body bodyOf(const scene::Geometry& geometry, const scene::Object& object) {
    Body body;
    std::unordered_map<std::uint32_t, std::uint32_t> places;
    for (std::uint32_t i = 0; i < object.indexCount; ++i) {
        const std::uint32_t index = geometry.indices[object.firstIndex + i];
        const auto [entry, isNew] = places.try_emplace(index, static_cast<std::uint32_t>(body.positions.size()));
        if (isNew) {
            body.positions.emplace_back(geometry.vertices[index].position);
            body.normals.push_back(glm::normalize(glm::dvec3(geometry.vertices[index].normal)));
        }
        body.indices.push_back(entry->second);
    }
    return body;
}

// IEC 61966-2-1, 8 bits to linear.
double linear(std::uint8_t byte) {
    const double x = byte / 255.0;
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

Cookie cookieOf(const scene::Texture& texture) {
    Cookie cookie{texture.width, texture.height, {}};
    for (std::size_t i = 0; i + 3 < texture.rgba.size(); i += 4) {
        cookie.luminance.push_back(0.2126 * linear(texture.rgba[i]) + 0.7152 * linear(texture.rgba[i + 1]) +
                                   0.0722 * linear(texture.rgba[i + 2]));
    }
    return cookie;
}

}  // namespace

World worldOf(const scene::Scene& scene, const scene::Light& light, ThinWalls thinWalls, Mirrors mirrors) {
    World world;
    for (const scene::Material& material : scene.materials) {
        if (material.mirror) {
            world.glasses.push_back({.absorption = optics::absorptionFromRgb(glm::dvec3(material.baseColor), 1.0), .mirror = true});
        } else {
            world.glasses.push_back({material.dispersion, material.absorption, material.priority});
        }
    }
    for (const scene::Object& object : scene.geometry->objects) {
        const scene::Material& material = scene.materials[static_cast<std::size_t>(object.material)];
        if (material.caster && material.thinWalled && thinWalls == ThinWalls::Absent) continue;
        Body body = bodyOf(*scene.geometry, object);
        const bool throws = material.mirror && mirrors == Mirrors::Casters;
        if (throws || (material.caster && !material.thinWalled)) body.glass = object.material;
        world.bodies.push_back(std::move(body));
    }
    world.light.type = light.type;
    world.light.position = glm::dvec3(light.position);
    world.light.direction = glm::normalize(glm::dvec3(light.direction));
    world.light.outerConeRad = static_cast<double>(light.outerConeDeg) * kRadiansPerDegree;
    world.light.innerConeRad = std::min(static_cast<double>(light.innerConeDeg) * kRadiansPerDegree, world.light.outerConeRad);
    world.light.spectrum = light.spectrum;
    if (light.cookie >= 0) world.light.cookie = cookieOf(scene.geometry->textures[static_cast<std::size_t>(light.cookie)]);
    world.outsideIndex = scene.outsideIndex;
    return world;
}

}  // namespace caustream::tracer
