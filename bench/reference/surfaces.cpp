#include "bench/reference/surfaces.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "error.h"

namespace caustream::tracer {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr double kSinglePrecision = 4e-7;  // of a coordinate: a few roundings of float
constexpr int kMostPasses = 256;           // faces passed by one ray before it is given up

double size(const glm::dvec3& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

// Keeps the interpolated normal only where it sees the ray from the side that the surface does.
void orient(Hit& hit, const glm::dvec3& direction) {
    const double surface = glm::dot(direction, hit.geometric);
    hit.entering = surface < 0.0;
    if (surface * glm::dot(direction, hit.shading) <= 0.0) hit.shading = hit.geometric;
}

RTCRayHit rayHit(const glm::dvec3& origin, const glm::dvec3& direction, double from, double to) {
    RTCRayHit ray{};
    ray.ray.org_x = static_cast<float>(origin.x);
    ray.ray.org_y = static_cast<float>(origin.y);
    ray.ray.org_z = static_cast<float>(origin.z);
    ray.ray.dir_x = static_cast<float>(direction.x);
    ray.ray.dir_y = static_cast<float>(direction.y);
    ray.ray.dir_z = static_cast<float>(direction.z);
    ray.ray.tnear = static_cast<float>(from);
    ray.ray.tfar = static_cast<float>(to);
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return ray;
}

}  // namespace

bool Inside::holds(int object) const { return std::find(objects_.begin(), objects_.begin() + count_, object) != objects_.begin() + count_; }

void Inside::enter(int object) {
    if (count_ == kMost) leave(objects_.front());
    objects_[static_cast<std::size_t>(count_++)] = object;
}

void Inside::leave(int object) {
    const auto end = objects_.begin() + count_, found = std::find(objects_.begin(), end, object);
    if (found == end) return;
    std::copy(found + 1, end, found);
    --count_;
}

struct Surfaces::Embree {
    template <auto Release>
    struct Releaser {
        template <class T>
        void operator()(T* pointer) const {
            Release(pointer);
        }
    };
    std::unique_ptr<RTCDeviceTy, Releaser<rtcReleaseDevice>> device{rtcNewDevice("threads=1")};
    std::unique_ptr<RTCSceneTy, Releaser<rtcReleaseScene>> all, receivers;

    void attach(RTCScene scene, const Body& body, unsigned id) const {
        RTCGeometry triangles = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                      3 * sizeof(float), body.positions.size()));
        for (const glm::dvec3& p : body.positions) {
            for (int axis = 0; axis < 3; ++axis) *positions++ = static_cast<float>(p[axis]);
        }
        void* indices = rtcSetNewGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                3 * sizeof(std::uint32_t), body.indices.size() / 3);
        std::copy(body.indices.begin(), body.indices.end(), static_cast<std::uint32_t*>(indices));
        rtcCommitGeometry(triangles);
        rtcAttachGeometryByID(scene, triangles, id);
        rtcReleaseGeometry(triangles);
    }
};

Surfaces::Surfaces(const World& world) : world_(world), embree_(std::make_unique<Embree>()) {
    if (!embree_->device) throw Error("Embree does not start; install libembree3-3 for this processor");
    for (auto* scene : {&embree_->all, &embree_->receivers}) {
        scene->reset(rtcNewScene(embree_->device.get()));
        // Robust: no ray slips between two triangles that share an edge.
        rtcSetSceneFlags(scene->get(), RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene->get(), RTC_BUILD_QUALITY_HIGH);
    }
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        const Body& body = world.bodies[i];
        if (body.indices.empty()) continue;
        embree_->attach(embree_->all.get(), body, static_cast<unsigned>(i));
        if (body.glass < 0) embree_->attach(embree_->receivers.get(), body, static_cast<unsigned>(i));
        for (const glm::dvec3& p : body.positions) reach_ = std::max(reach_, 4.0 * size(p));
    }
    rtcCommitScene(embree_->all.get());
    rtcCommitScene(embree_->receivers.get());
}

Surfaces::~Surfaces() = default;

Hit Surfaces::refine(int bodyIndex, std::uint32_t triangle, const glm::dvec3& origin, const glm::dvec3& direction) const {
    const Body& body = world_.bodies[static_cast<std::size_t>(bodyIndex)];
    const std::uint32_t* corner = &body.indices[3 * static_cast<std::size_t>(triangle)];
    const glm::dvec3 a = body.positions[corner[0]];
    const glm::dvec3 ab = body.positions[corner[1]] - a, ac = body.positions[corner[2]] - a, to = a - origin;
    const glm::dvec3 area = glm::cross(ab, ac);
    const double along = glm::dot(direction, area), area2 = glm::dot(area, area);
    Hit hit;
    if (along == 0.0 || area2 == 0.0) return hit;
    hit.object = bodyIndex;
    hit.glass = body.glass;
    hit.distance = glm::dot(to, area) / along;
    hit.geometric = area / std::sqrt(area2);
    if (body.glass >= 0) {
        // Moeller & Trumbore 1997, Fast, Minimum Storage Ray/Triangle Intersection. Clamped, as the candidate may have
        // been chosen by a rounding's breadth from an edge.
        const glm::dvec3 turned = glm::cross(to, direction);
        const double u = std::clamp(glm::dot(turned, ac) / along, 0.0, 1.0);
        const double v = std::clamp(-glm::dot(turned, ab) / along, 0.0, 1.0 - u);
        hit.shading = glm::normalize((1.0 - u - v) * body.normals[corner[0]] + u * body.normals[corner[1]] + v * body.normals[corner[2]]);
        if (!(glm::dot(hit.shading, hit.shading) > 0.5)) hit.shading = hit.geometric;
    }
    orient(hit, direction);
    return hit;
}

// A convex solid is left from within and entered from without; a ray that just left it does not meet it again.
bool Surfaces::solidHit(std::size_t solid, const glm::dvec3& origin, const glm::dvec3& direction, bool within, Hit& hit) const {
    double distance = within ? kFar : -kFar;
    glm::dvec3 normal(0.0);
    if (const auto* sphere = std::get_if<Sphere>(&world_.solids[solid].shape)) {
        const glm::dvec3 from = origin - sphere->centre;
        const double b = glm::dot(from, direction);
        const glm::dvec3 closest = from - b * direction;
        const double h2 = sphere->radius * sphere->radius - glm::dot(closest, closest);
        if (h2 < 0.0 && !within) return false;
        const double h = std::sqrt(std::max(h2, 0.0));
        distance = std::max(within ? h - b : -h - b, within ? 0.0 : -kFar);
        normal = glm::normalize(from + distance * direction);
    } else {
        double leaves = kFar;
        for (const glm::dvec4& plane : std::get<ConvexPlanes>(world_.solids[solid].shape).planes) {
            const glm::dvec3 outward(plane);
            const double along = glm::dot(outward, direction), t = (plane.w - glm::dot(outward, origin)) / along;
            if (along > 0.0) {
                if (within && t < distance) distance = t, normal = outward;
                leaves = std::min(leaves, t);
            } else if (!within && along < 0.0 && t > distance) {
                distance = t, normal = outward;
            } else if (!within && along == 0.0 && glm::dot(outward, origin) > plane.w) {
                return false;
            }
        }
        if (!within && distance >= leaves) return false;
        if (within) distance = std::max(distance, 0.0);
    }
    if (!(distance >= 0.0) || distance >= hit.distance) return false;
    hit.distance = distance;
    hit.object = static_cast<int>(world_.bodies.size() + solid);
    hit.glass = world_.solids[solid].glass;
    hit.geometric = hit.shading = normal;
    hit.entering = !within;
    return true;
}

Hit Surfaces::nearest(const glm::dvec3& origin, const glm::dvec3& direction, const Inside& inside, int onSolid) const {
    Hit best;
    best.distance = kFar;
    for (std::size_t i = 0; i < world_.solids.size(); ++i) {
        const bool within = inside.holds(static_cast<int>(world_.bodies.size() + i));
        if (within || static_cast<int>(i) != onSolid) solidHit(i, origin, direction, within, best);
    }
    double from = kSinglePrecision * size(origin);
    for (int pass = 0; pass < kMostPasses; ++pass) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit ray = rayHit(origin, direction, from, best.distance);
        rtcIntersect1(embree_->all.get(), &context, &ray);
        if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return best;
        const Hit hit = refine(static_cast<int>(ray.hit.geomID), ray.hit.primID, origin, direction);
        const bool contradicts = hit.glass >= 0 && !mirror(hit.glass) && hit.entering == inside.holds(hit.object);
        if (hit.object >= 0 && !contradicts) return hit.distance < best.distance ? hit : best;
        from = static_cast<double>(ray.ray.tfar) + kSinglePrecision * (size(origin) + static_cast<double>(ray.ray.tfar));
    }
    return best;
}

bool Surfaces::receiverBetween(const glm::dvec3& from, const glm::dvec3& to) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray = rayHit(from, to - from, 0.0, 1.0 - 1e-4);
    rtcOccluded1(embree_->receivers.get(), &context, &ray.ray);
    return ray.ray.tfar < 0.0f;  // Embree's word for occluded
}

Inside Surfaces::around(const glm::dvec3& point) const {
    Inside inside;
    // Unlikely to run along anyone's edges.
    const std::array<glm::dvec3, 3> ways{glm::normalize(glm::dvec3(0.5377, 0.8339, 0.2588)),
                                         glm::normalize(glm::dvec3(-0.3077, 0.4336, -0.8622)),
                                         glm::normalize(glm::dvec3(0.7254, -0.6631, 0.3147))};
    for (std::size_t body = 0; body < world_.bodies.size(); ++body) {
        if (world_.bodies[body].glass < 0 || mirror(world_.bodies[body].glass)) continue;
        int votes = 0;
        for (const glm::dvec3& way : ways) {
            int crossings = 0;
            double from = 0.0;
            for (int pass = 0; pass < kMostPasses; ++pass) {
                RTCIntersectContext context;
                rtcInitIntersectContext(&context);
                RTCRayHit ray = rayHit(point, way, from, kFar);
                rtcIntersect1(embree_->all.get(), &context, &ray);
                if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) break;
                const Hit hit = refine(static_cast<int>(ray.hit.geomID), ray.hit.primID, point, way);
                if (hit.object == static_cast<int>(body)) crossings += hit.entering ? -1 : 1;
                from = static_cast<double>(ray.ray.tfar) * (1.0 + 2.0 * kSinglePrecision) + kSinglePrecision * size(point);
            }
            votes += crossings > 0;
        }
        if (votes >= 2) inside.enter(static_cast<int>(body));
    }
    for (std::size_t i = 0; i < world_.solids.size(); ++i) {
        bool holds = !mirror(world_.solids[i].glass);
        if (const auto* sphere = std::get_if<Sphere>(&world_.solids[i].shape)) {
            holds = holds && glm::length(point - sphere->centre) < sphere->radius;
        } else {
            for (const glm::dvec4& plane : std::get<ConvexPlanes>(world_.solids[i].shape).planes) {
                holds = holds && glm::dot(glm::dvec3(plane), point) < plane.w;
            }
        }
        if (holds) inside.enter(static_cast<int>(world_.bodies.size() + i));
    }
    return inside;
}

}  // namespace caustream::tracer
