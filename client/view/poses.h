// What a dragging hand does to the camera and to a light. Pure: no window, no connection.
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace caustream::view {

struct Pose {
    glm::dvec3 eye{0, 1, 3}, target{0}, up{0, 1, 0};
    double fovYDeg = 40.0;

    glm::dvec3 forward() const;  // unit
    glm::dvec3 right() const;    // unit
    double distance() const;
};

// All moves are in fractions of the picture's height, x to the right, y down.
void orbit(Pose& pose, glm::dvec2 move);  // about the target, around the world's Y; stops short of the poles
void pan(Pose& pose, glm::dvec2 move);    // what is under the pointer stays under it, at the target's depth
void zoom(Pose& pose, double steps);      // > 0: nearer

struct Room {
    glm::dvec3 min, max;
    bool holds(const glm::dvec3& point) const;
};

struct LightPose {
    glm::dvec3 position{0, 2, 0}, direction{0, -1, 0};
};

// What a dragged light circles, and how far it stays away.
struct LightPath {
    glm::dvec3 target{0};
    double distance = 1.0;
    std::optional<Room> room;  // it stays within: walls that are nearer than the distance bring it closer
};

// Around the target, and aimed at it: right goes to the picture's right, up goes away from the eye, or up where the
// light stands low. The direction's length is 1 afterwards.
void dragLight(LightPose& light, const LightPath& path, const Pose& camera, glm::dvec2 move);

// Where a light shines: the point of its axis that is nearest to `centre`, in front of it.
glm::dvec3 lightTarget(const LightPose& light, glm::dvec3 centre);

}  // namespace caustream::view
