// Nearest hits, refined in double precision. Embree finds the candidate triangle in single precision; distance,
// barycentrics and normals are then computed anew from the doubles. Solids are met exactly. Within a rounding of an edge
// the triangle is Embree's choice: on the built-in scenes 1 to 8 of a million hits lie just outside theirs.
#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <span>

#include "bench/reference/world.h"

namespace caustream::tracer {

// The bodies and solids a path is inside of, the last entered last. Objects count bodies first, then solids.
class Inside {
 public:
    static constexpr int kMost = 16;   // as many casters as a loaded scene may have
    bool empty() const { return count_ == 0; }
    std::span<const std::int32_t> objects() const { return {objects_.data(), static_cast<std::size_t>(count_)}; }
    bool holds(int object) const;
    void enter(int object);  // beyond kMost the first entered is forgotten
    void leave(int object);

 private:
    std::array<std::int32_t, kMost> objects_{};
    int count_ = 0;
};

struct Hit {
    double distance = 0.0;      // m
    int object = -1;            // -1: nothing met
    int glass = -1;             // -1: a receiver
    bool entering = false;      // against the outward side of a glass
    glm::dvec3 geometric{0.0};  // outward unit normal of the surface itself
    glm::dvec3 shading{0.0};    // interpolated, unit; the geometric one where they disagree about the ray's side
};

class Surfaces {
 public:
    // Keeps a reference to `world`. Throws Error when Embree does not start.
    explicit Surfaces(const World& world);
    ~Surfaces();

    // The first surface along a ray that began on solid `onSolid` (-1: on none). Faces that contradict `inside` (the
    // front of what it is in already, the back of what it is not in) are passed: open meshes, rounding. Mirrors have no inside.
    Hit nearest(const glm::dvec3& origin, const glm::dvec3& direction, const Inside& inside, int onSolid) const;

    // A receiver strictly between two points; the last 1e-4 of the way does not count.
    bool receiverBetween(const glm::dvec3& from, const glm::dvec3& to) const;

    // What holds `point`, by counting crossings along three rays.
    Inside around(const glm::dvec3& point) const;

    // Of all bodies, m: a length that leaves the scene from anywhere in it.
    double reach() const { return reach_; }

 private:
    struct Embree;
    bool mirror(int glass) const { return glass >= 0 && world_.glasses[static_cast<std::size_t>(glass)].mirror; }
    bool solidHit(std::size_t solid, const glm::dvec3& origin, const glm::dvec3& direction, bool within, Hit& hit) const;
    Hit refine(int body, std::uint32_t triangle, const glm::dvec3& origin, const glm::dvec3& direction) const;

    const World& world_;
    std::unique_ptr<Embree> embree_;
    double reach_ = 0.0;
};

}  // namespace caustream::tracer
