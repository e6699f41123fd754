#include "client/view/poses.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <numbers>

namespace caustream::view {
namespace {

constexpr double kOrbitPerHeight = std::numbers::pi;  // half a turn for a drag over the whole picture
constexpr double kPole = 0.02;                        // rad: how near to straight up or down the eye may come
constexpr double kZoomPerStep = 0.88;
constexpr double kLightPerHeight = 2.0;  // times the distance from its target
constexpr double kWallShare = 0.97;      // of the way to a wall that a light may go
constexpr glm::dvec3 kWorldUp{0, 1, 0};

// Along the unit vector `direction` from a point in the room, a little short of the wall.
double distanceToWall(const glm::dvec3& from, const glm::dvec3& direction, const Room& room) {
    double nearest = 1e9;
    for (int i = 0; i < 3; ++i)
        if (direction[i] != 0.0)
            nearest = std::min(nearest, ((direction[i] > 0.0 ? room.max[i] : room.min[i]) - from[i]) / direction[i]);
    return kWallShare * nearest;
}

double radians(double degrees) {
    return degrees * std::numbers::pi / 180.0;
}

}  // namespace

glm::dvec3 Pose::forward() const {
    return glm::normalize(target - eye);
}

glm::dvec3 Pose::right() const {
    const glm::dvec3 side = glm::cross(forward(), up);
    const double length = glm::length(side);
    return length > 1e-9 ? side / length : glm::dvec3{1, 0, 0};  // straight up or down: any side will do
}

double Pose::distance() const {
    return glm::distance(eye, target);
}

void orbit(Pose& pose, glm::dvec2 move) {
    const double radius = pose.distance();
    const glm::dvec3 offset = (pose.eye - pose.target) / radius;
    double azimuth = std::atan2(offset.x, offset.z), polar = std::acos(std::clamp(offset.y, -1.0, 1.0));
    azimuth -= move.x * kOrbitPerHeight;
    polar = std::clamp(polar - move.y * kOrbitPerHeight, kPole, std::numbers::pi - kPole);
    pose.eye = pose.target + radius * glm::dvec3{std::sin(polar) * std::sin(azimuth), std::cos(polar),
                                                 std::sin(polar) * std::cos(azimuth)};
    pose.up = kWorldUp;
}

void pan(Pose& pose, glm::dvec2 move) {
    const double heightAtTarget = 2.0 * pose.distance() * std::tan(0.5 * radians(pose.fovYDeg));
    const glm::dvec3 right = pose.right(), up = glm::cross(right, pose.forward());
    const glm::dvec3 shift = heightAtTarget * (-move.x * right + move.y * up);
    pose.eye += shift;
    pose.target += shift;
}

void zoom(Pose& pose, double steps) {
    pose.eye = pose.target + (pose.eye - pose.target) * std::pow(kZoomPerStep, std::clamp(steps, -20.0, 20.0));
}

bool Room::holds(const glm::dvec3& point) const {
    return glm::all(glm::greaterThan(point, min)) && glm::all(glm::lessThan(point, max));
}

void dragLight(LightPose& light, const LightPath& path, const Pose& camera, glm::dvec2 move) {
    const glm::dvec3 offset = light.position - path.target;
    const double distance = glm::length(offset);
    if (distance < 1e-9) return;
    const glm::dvec3 right = camera.right();
    // A light overhead moves over the ground, a low one rises and falls: the way that is more across its beam.
    const bool overhead = std::abs(offset.y) > 0.6 * distance;
    const glm::dvec3 away = overhead ? glm::normalize(glm::cross(kWorldUp, right)) : kWorldUp;
    const glm::dvec3 moved = offset + kLightPerHeight * distance * (move.x * right - move.y * away);
    const glm::dvec3 from = glm::normalize(moved);
    const double reach =
        path.room ? std::min(path.distance, distanceToWall(path.target, from, *path.room)) : path.distance;
    light.position = path.target + from * reach;
    light.direction = -from;
}

glm::dvec3 lightTarget(const LightPose& light, glm::dvec3 centre) {
    const glm::dvec3 axis = glm::normalize(light.direction);
    const double along = glm::dot(centre - light.position, axis);
    const double distance = glm::distance(centre, light.position);
    return light.position + axis * (along > 0.1 * distance ? along : std::max(distance, 1e-3));
}

}  // namespace caustream::view
