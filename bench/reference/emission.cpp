#include "bench/reference/emission.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

namespace caustream::tracer {

namespace {

constexpr double kPi = std::numbers::pi;

glm::dmat3 frameAlong(const glm::dvec3& z, const glm::dvec3& up) {
    glm::dvec3 x = glm::cross(z, up);
    if (glm::dot(x, x) < 1e-8) x = glm::cross(z, std::abs(z.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0));
    x = glm::normalize(x);
    return {x, glm::cross(x, z), z};
}

// Corners of a polygon around the outline of a sphere as the light sees it; the light itself when it is inside.
void addOutline(std::vector<glm::dvec3>& points, const Sphere& sphere, const Light& light) {
    constexpr int kCorners = 64;
    const bool directional = light.type == scene::LightType::Directional;
    const glm::dvec3 to = directional ? light.direction : sphere.centre - light.position;
    const double distance = glm::length(to);
    if (!directional && distance <= sphere.radius) return points.push_back(light.position);
    const double sine = directional ? 0.0 : sphere.radius / distance;
    if (directional) points.push_back(sphere.centre - sphere.radius * to);   // the rays begin before it
    const glm::dmat3 frame = frameAlong(to / distance, glm::dvec3(0, 1, 0));
    const double across = sphere.radius * std::sqrt(1.0 - sine * sine) / std::cos(kPi / kCorners);
    for (int i = 0; i < kCorners; ++i) {
        const double angle = 2.0 * kPi * i / kCorners;
        points.push_back(sphere.centre + frame * glm::dvec3(across * std::cos(angle), across * std::sin(angle), -sphere.radius * sine));
    }
}

// Points whose hull, seen from the light, holds all glass.
std::vector<glm::dvec3> hullPoints(const World& world) {
    std::vector<glm::dvec3> points;
    for (const Body& body : world.bodies) {
        if (body.glass >= 0) points.insert(points.end(), body.positions.begin(), body.positions.end());
    }
    for (const Solid& solid : world.solids) {
        if (const auto* sphere = std::get_if<Sphere>(&solid.shape)) {
            addOutline(points, *sphere, world.light);
            continue;
        }
        const auto& planes = std::get<ConvexPlanes>(solid.shape).planes;
        double reach = 0.0;
        for (const glm::dvec4& plane : planes) reach = std::max(reach, std::abs(plane.w));
        for (std::size_t i = 0; i < planes.size(); ++i) {
            for (std::size_t j = i + 1; j < planes.size(); ++j) {
                for (std::size_t k = j + 1; k < planes.size(); ++k) {
                    const glm::dvec3 a(planes[i]), b(planes[j]), c(planes[k]);
                    const double det = glm::dot(a, glm::cross(b, c));
                    if (std::abs(det) < 1e-9) continue;
                    const glm::dvec3 p = (planes[i].w * glm::cross(b, c) + planes[j].w * glm::cross(c, a) +
                                          planes[k].w * glm::cross(a, b)) / det;
                    const bool inside = std::all_of(planes.begin(), planes.end(), [&](const glm::dvec4& plane) {
                        return glm::dot(glm::dvec3(plane), p) <= plane.w + 1e-7 * (reach + glm::length(p));
                    });
                    if (inside) points.push_back(p);
                }
            }
        }
    }
    return points;
}

// Badoiu & Clarkson 2003, Smaller Core-Sets for Balls: steps of shrinking length towards the farthest point.
glm::dvec3 ballCentre(const std::vector<glm::dvec3>& points) {
    glm::dvec3 centre = points.front();
    for (int step = 1; step <= 64; ++step) {
        const auto farthest = std::max_element(points.begin(), points.end(), [&](const auto& a, const auto& b) {
            return glm::dot(a - centre, a - centre) < glm::dot(b - centre, b - centre);
        });
        centre += (*farthest - centre) / (step + 1.0);
    }
    return centre;
}

// Hulls of glass in front of the light do not reach beyond the cone of their points; around it they take everything.
struct Cone {
    glm::dvec3 axis{0, 0, 1};
    double angle = kPi;
};

Cone coneTo(const std::vector<glm::dvec3>& points, const glm::dvec3& from) {
    glm::dvec3 low = points.front(), high = low;
    for (const glm::dvec3& p : points) low = glm::min(low, p), high = glm::max(high, p);
    const double reach = glm::length(high - low);
    std::vector<glm::dvec3> directions;
    for (const glm::dvec3& p : points) {
        const double distance = glm::length(p - from);
        if (distance <= 1e-9 * reach) return {};
        directions.push_back((p - from) / distance);
    }
    const glm::dvec3 middle = ballCentre(directions);
    if (glm::length(middle) < 1e-3) return {};
    Cone cone{glm::normalize(middle), 0.0};
    for (const glm::dvec3& d : directions) {
        cone.angle = std::max(cone.angle, std::atan2(glm::length(glm::cross(cone.axis, d)), glm::dot(cone.axis, d)));
    }
    cone.angle = cone.angle * (1.0 + 1e-9) + 1e-9;
    // Points on all sides, or nearly: the light may be inside their hull.
    return cone.angle < 0.499 * kPi ? cone : Cone{};
}

}  // namespace

Emission::Emission(const World& world) : light_(world.light) {
    directional_ = light_.type == scene::LightType::Directional;
    cookieFrame_ = frameAlong(light_.direction, glm::dvec3(0, 1, 0));
    const std::vector<glm::dvec3> points = hullPoints(world);
    if (points.empty()) return;
    if (directional_) {
        const glm::dvec3 middle = ballCentre(points);
        frame_ = frameAlong(light_.direction, glm::dvec3(0, 1, 0));
        double back = 0.0;
        for (const glm::dvec3& p : points) {
            radius_ = std::max(radius_, glm::length(glm::cross(p - middle, light_.direction)));
        }
        // Behind everything, so that opaque bodies before the glass shade it.
        for (const Body& body : world.bodies) {
            for (const glm::dvec3& p : body.positions) back = std::min(back, glm::dot(p - middle, light_.direction));
        }
        for (const glm::dvec3& p : points) back = std::min(back, glm::dot(p - middle, light_.direction));
        radius_ *= 1.0 + 1e-9;
        origin_ = middle + (back - 0.01 * radius_) * light_.direction;
        extent_ = kPi * radius_ * radius_;
        return;
    }
    origin_ = light_.position;
    Cone cone = coneTo(points, origin_);
    if (light_.type == scene::LightType::Spot) {
        const double outer = light_.outerConeRad;
        cosInner_ = std::cos(std::min(light_.innerConeRad, outer)), cosOuter_ = std::cos(outer);
        const double between = std::acos(std::clamp(glm::dot(cone.axis, light_.direction), -1.0, 1.0));
        if (cone.angle < kPi && between > cone.angle + outer + 1e-9) return;
        if (outer < cone.angle) cone = {light_.direction, outer};
    }
    frame_ = frameAlong(cone.axis, glm::dvec3(0, 1, 0));
    const double sine = std::sin(0.5 * cone.angle);
    versine_ = 2.0 * sine * sine;
    extent_ = 2.0 * kPi * versine_;
}

Ray Emission::sample(double s, double t) const {
    const double azimuth = 2.0 * kPi * t, c = std::cos(azimuth), d = std::sin(azimuth);
    if (directional_) {
        const double r = radius_ * std::sqrt(s);
        return {origin_ + frame_ * glm::dvec3(r * c, r * d, 0.0), light_.direction};
    }
    // From the versine: 1 - cosine of a narrow cone would lose its digits.
    const double versine = versine_ * s, sine = std::sqrt(versine * (2.0 - versine));
    return {origin_, glm::normalize(frame_ * glm::dvec3(sine * c, sine * d, 1.0 - versine))};
}

// KHR_lights_punctual, "Inner and Outer Cone Angles": a squared ramp in the cosine.
double Emission::share(const glm::dvec3& direction) const {
    double share = 1.0;
    if (light_.type == scene::LightType::Spot) {
        const double c = glm::dot(direction, light_.direction);
        if (c < cosOuter_ - 1e-15) return 0.0;
        if (cosInner_ - cosOuter_ >= 1e-6) {
            const double ramp = std::clamp((c - cosOuter_) / (cosInner_ - cosOuter_), 0.0, 1.0);
            share = ramp * ramp;
        }
    }
    return light_.cookie.luminance.empty() ? share : share * cookieAt(direction);
}

// Bilinear between texel middles, the edge texels beyond them.
double Emission::cookieAt(const glm::dvec3& direction) const {
    const Cookie& cookie = light_.cookie;
    const double along = glm::dot(direction, cookieFrame_[2]);
    if (along <= 0.0) return 0.0;
    const double scale = 0.5 / (along * std::tan(std::min(light_.outerConeRad, 1.5)));
    const double x = (0.5 + scale * glm::dot(direction, cookieFrame_[0])) * cookie.width - 0.5;
    const double y = (0.5 - scale * glm::dot(direction, cookieFrame_[1])) * cookie.height - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    const auto texel = [&](double column, double row) {
        const auto i = static_cast<std::size_t>(std::clamp(column, 0.0, cookie.width - 1.0));
        const auto j = static_cast<std::size_t>(std::clamp(row, 0.0, cookie.height - 1.0));
        return cookie.luminance[j * static_cast<std::size_t>(cookie.width) + i];
    };
    return std::lerp(std::lerp(texel(left, top), texel(left + 1, top), x - left),
                     std::lerp(texel(left, top + 1), texel(left + 1, top + 1), x - left), y - top);
}

}  // namespace caustream::tracer
