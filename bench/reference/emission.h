// Where photons start: directions (or, for a directional light, places) that cover the casters within the light's cone.
#pragma once
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "bench/reference/world.h"

namespace caustream::tracer {

struct Ray {
    glm::dvec3 origin{0.0}, direction{0.0};  // direction unit
};

class Emission {
 public:
    // The light's cone or the cone to the casters, whichever is the smaller; a directional light's disc around them.
    explicit Emission(const World& world);

    // Solid angle, sr, or area, m^2, of all samples together; 0 when the cones do not meet or nothing is glass.
    double extent() const { return extent_; }

    // Uniform in `extent` over the unit square.
    Ray sample(double s, double t) const;

    // Intensity along `direction` over that on the axis: cone and cookie, 0..1.
    double share(const glm::dvec3& direction) const;

 private:
    double cookieAt(const glm::dvec3& direction) const;

    Light light_;
    bool directional_ = false;
    double extent_ = 0.0;
    double versine_ = 0.0;         // 1 - cosine of the half angle sampled
    double radius_ = 0.0;          // of the disc
    glm::dvec3 origin_{0.0};       // of the rays, or the disc's middle
    glm::dmat3 frame_{1.0};        // columns x, y across and z along the samples' axis
    glm::dmat3 cookieFrame_{1.0};  // columns right, up, along the light's own axis
    double cosInner_ = -2.0, cosOuter_ = -3.0;
};

}  // namespace caustream::tracer
