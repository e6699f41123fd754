// Where a picture is taken from: the camera's view and every view from the light. View space looks down -Z; the depth of
// a point is z = -view.z > 0. shaders/common/view.glsl is its twin.
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <initializer_list>

#include "gl/uniforms.h"

namespace caustream::render {

struct View {
    glm::mat4 worldToView{1.0f};       // rigid
    glm::vec2 halfExtent{1.0f};        // perspective: tangents of the half angles; parallel: metres
    float nearM = 0.01f, farM = 100.0f;
    bool perspective = true;
    glm::vec2 shift{0.0f};             // of what is drawn, in halves of the window: to sample pixels beside their middles

    // Reversed depth in 0..1 with GL_ZERO_TO_ONE: near/z (perspective, no far plane), 1 at near to 0 at far (parallel).
    // Both are linear in the image on a plane. Cleared to 0, tested with GL_GREATER.
    glm::mat4 viewToClip() const;
    glm::mat4 worldToClip() const { return viewToClip() * worldToView; }
    glm::vec3 position() const;        // of the eye, world space; meaningless for a parallel view
    glm::vec3 forward() const;         // unit, world space
    glm::vec3 toView(const glm::vec3& world) const { return glm::vec3(worldToView * glm::vec4(world, 1.0f)); }

    // Solid angle (perspective) or area (parallel) of the whole window.
    double extent() const;
    bool operator==(const View&) const = default;
};

// Rigid world -> view for an eye at `position` looking along unit `forward`, `up` a hint that may be parallel to it.
glm::mat4 lookAlong(const glm::vec3& position, const glm::vec3& forward, const glm::vec3& up);

// kViews of common/view.glsl: 1 when all are perspective, 2 when all are parallel, 0 when each has to say so itself.
int viewsFlag(std::initializer_list<const View*> views);

// Sets the members of a GLSL `uniform View <name>`.
void setView(const gl::Uniforms& uniforms, const char* name, const View& view);

}  // namespace caustream::render
