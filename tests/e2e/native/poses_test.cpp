// What a dragging hand does, against geometry.
#include "client/view/poses.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace caustream::view {
namespace {

constexpr double kRounding = 1e-9;

TEST(Poses, OrbitKeepsDistanceAndTargetAndStopsAtThePoles) {
    Pose pose{{1, 2, 4}, {0, 1, 0}};
    const double distance = pose.distance();
    for (int i = 0; i < 50; ++i) {
        orbit(pose, {0.13, i < 25 ? 0.1 : -0.1});
        EXPECT_NEAR(pose.distance(), distance, kRounding);
        EXPECT_GT(glm::length(glm::cross(pose.forward(), pose.up)), 0.01) << "never straight up or down";
    }
    EXPECT_EQ(pose.target, glm::dvec3(0, 1, 0));
}

TEST(Poses, DraggingRightTurnsTheSceneToTheRight) {
    Pose pose{{0, 0, 5}, {0, 0, 0}};
    orbit(pose, {0.1, 0});
    EXPECT_LT(pose.eye.x, 0.0) << "the eye goes left, so that the scene goes right";
}

TEST(Poses, PanMovesEyeAndTargetAlikeAcrossTheView) {
    Pose pose{{1, 2, 4}, {0, 1, 0}};
    const Pose before = pose;
    pan(pose, {0.2, -0.1});
    EXPECT_NEAR(glm::distance(pose.eye - before.eye, pose.target - before.target), 0.0, kRounding);
    EXPECT_NEAR(glm::dot(pose.eye - before.eye, before.forward()), 0.0, kRounding);
}

TEST(Poses, ADraggedLightKeepsItsDistanceAndItsTarget) {
    const Pose camera{{0, 1, 4}, {0, 0.5, 0}};
    LightPose light{{0.3, 3, 0.2}, {0, -1, 0}};
    const LightPath path{.target = {0, 0.5, 0}, .distance = glm::distance(light.position, glm::dvec3(0, 0.5, 0))};
    const double x = light.position.x;
    dragLight(light, path, camera, {0.1, 0});
    EXPECT_GT(light.position.x, x);
    for (int i = 0; i < 30; ++i) {
        dragLight(light, path, camera, {0.03, 0.02});
        EXPECT_NEAR(glm::distance(light.position, path.target), path.distance, kRounding);
        const glm::dvec3 hit = light.position + light.direction * path.distance;
        EXPECT_NEAR(glm::distance(hit, path.target), 0.0, kRounding);
    }
}

TEST(Poses, ALightInARoomStaysThere) {
    const Pose camera{{0, 1, 4}, {0, 0.5, 0}};
    LightPose light{{0, 1.9, 0}, {0, -1, 0}};
    const Room room{{-1, 0, -1}, {1, 2, 1}};
    const LightPath path{.target = {0, 0.5, 0}, .distance = 1.4, .room = room};
    for (int i = 0; i < 60; ++i) {
        dragLight(light, path, camera, {0.05, 0.01});
        ASSERT_TRUE(room.holds(light.position)) << "step " << i;
    }
}

TEST(Poses, ALightShinesWhereItsAxisPassesTheScene) {
    const LightPose light{{0, 3, 0}, {0, -1, 0}};
    const glm::dvec3 target = lightTarget(light, {0.2, 1, 0});
    EXPECT_NEAR(glm::distance(target, glm::dvec3(0, 1, 0)), 0.0, kRounding);
    // Turned away from the scene, it still has a point in front of it.
    const glm::dvec3 away = lightTarget({{0, 3, 0}, {0, 1, 0}}, {0, 1, 0});
    EXPECT_GT(away.y, 3.0);
}

}  // namespace
}  // namespace caustream::view
