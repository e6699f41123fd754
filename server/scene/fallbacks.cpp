#include "scene/fallbacks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace caustream::scene {

namespace {

// A single point still has a size to place things by.
float sizeOf(const Bounds& subject) {
    const float radius = subject.radius();
    return std::max(radius, 1e-6f * std::max(1.0f, glm::length(subject.centre())));
}

}  // namespace

Light placeLight(const Bounds& subject, const Bounds& everything) {
    constexpr float kDistanceInRadii = 5.0f, kConeMargin = 1.8f, kIlluminanceLx = 1000.0f;
    constexpr float kMaxIntensityCd = 1e12f;  // as of any light
    const float radius = sizeOf(subject);
    const glm::vec3 centre = subject.centre();
    Light light;
    light.name = "light";
    light.position = centre + kDistanceInRadii * radius * glm::normalize(glm::vec3(0.35f, 1.0f, -0.3f));
    // In a room, below its ceiling.
    if (everything.max.y > subject.max.y + radius)
        light.position.y = std::min(light.position.y, glm::mix(subject.max.y, everything.max.y, 0.95f));
    const float distance = glm::distance(light.position, centre);
    light.direction = (centre - light.position) / distance;
    light.outerConeDeg = std::min(60.0f, kConeMargin * glm::degrees(std::asin(std::min(0.95f, radius / distance))));
    light.innerConeDeg = 0.8f * light.outerConeDeg;
    light.intensity = std::min(kIlluminanceLx * distance * distance, kMaxIntensityCd);
    return light;
}

Camera placeCamera(const Bounds& subject) {
    constexpr float kFovDeg = 40.0f, kDistanceInRadii = 4.3f;
    const float radius = sizeOf(subject);
    Camera camera;
    camera.name = "camera";
    camera.target = subject.centre() - glm::vec3(0.0f, 0.4f * radius, 0.0f);
    camera.eye = camera.target + kDistanceInRadii * radius * glm::normalize(glm::vec3(0.25f, 0.55f, 1.0f));
    camera.fovYDeg = kFovDeg;
    return camera;
}

std::vector<Vertex> placeFloor(const Bounds& subject) {
    constexpr float kHalfWidthInRadii = 8.0f, kGapInRadii = 1e-3f;  // the gap keeps a flat base from flickering
    const float radius = sizeOf(subject), half = kHalfWidthInRadii * radius;
    const glm::vec3 middle(subject.centre().x, subject.min.y - kGapInRadii * radius, subject.centre().z);
    const auto corner = [&](float x, float z) {
        return Vertex{middle + half * glm::vec3(x, 0, z), {0, 1, 0}, {0.5f + 0.5f * x, 0.5f + 0.5f * z}};
    };
    return {corner(-1, 1), corner(1, 1), corner(1, -1), corner(-1, -1)};
}

}  // namespace caustream::scene
