// What CoarseTrace keeps: Embree's scenes of one geometry. For its two source files alone.
#pragma once
#include <embree3/rtcore.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "render/coarse_trace.h"

namespace caustream::render {

template <auto Release>
struct Releaser {
    template <class T>
    void operator()(T* pointer) const {
        Release(pointer);
    }
};

struct CoarseTrace::Impl {
    using Device = std::unique_ptr<RTCDeviceTy, Releaser<rtcReleaseDevice>>;
    using Scene = std::unique_ptr<RTCSceneTy, Releaser<rtcReleaseScene>>;
    struct Hit {
        float distance = 0.0f;
        glm::vec3 normal{0.0f};      // interpolated, unit
        glm::vec3 geometric{0.0f};   // the triangle's own, unit; 0 where it has none
        const scene::Object* object = nullptr;
    };

    std::shared_ptr<const scene::Geometry> geometry;
    Device device{rtcNewDevice("threads=1")};
    Scene receivers;
    std::vector<Scene> casters;   // by object; null for receivers
    Scene all;                    // receivers and casters

    void attach(RTCScene scene, const scene::Object& object) const {
        RTCGeometry triangles = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, geometry->vertices.data(),
                                   0, sizeof(scene::Vertex), geometry->vertices.size());
        rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, geometry->indices.data(),
                                   object.firstIndex * sizeof(std::uint32_t), 3 * sizeof(std::uint32_t),
                                   object.indexCount / 3);
        rtcSetGeometryUserData(triangles, const_cast<scene::Object*>(&object));
        rtcCommitGeometry(triangles);
        rtcAttachGeometry(scene, triangles);
        rtcReleaseGeometry(triangles);
    }

    std::optional<Hit> intersect(RTCScene scene, const glm::vec3& origin, const glm::vec3& direction,
                                 float from) const {
        // Embree takes no ray without a direction: what came to nothing in float arithmetic meets nothing.
        const auto finite = [](const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
        if (!finite(origin) || !finite(direction)) return std::nullopt;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit ray{};
        ray.ray.org_x = origin.x, ray.ray.org_y = origin.y, ray.ray.org_z = origin.z;
        ray.ray.dir_x = direction.x, ray.ray.dir_y = direction.y, ray.ray.dir_z = direction.z;
        ray.ray.tnear = from;
        ray.ray.tfar = std::numeric_limits<float>::infinity();
        ray.ray.mask = ~0u;
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene, &context, &ray);
        if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

        const auto* object =
            static_cast<const scene::Object*>(rtcGetGeometryUserData(rtcGetGeometry(scene, ray.hit.geomID)));
        const std::uint32_t* corner = &geometry->indices[object->firstIndex + 3 * ray.hit.primID];
        const auto& vertices = geometry->vertices;
        const glm::vec3 normal = (1.0f - ray.hit.u - ray.hit.v) * vertices[corner[0]].normal +
                                 ray.hit.u * vertices[corner[1]].normal + ray.hit.v * vertices[corner[2]].normal;
        const glm::vec3 flat(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z);
        const float length = glm::length(flat);
        const glm::vec3 geometric = length > 0.0f ? flat / length : glm::vec3(0.0f);
        if (glm::dot(normal, normal) > 1e-12f) return Hit{ray.ray.tfar, glm::normalize(normal), geometric, object};
        // Normals that cancel out between opposite ones: the triangle's own
        return length > 0.0f ? std::optional(Hit{ray.ray.tfar, geometric, geometric, object}) : std::nullopt;
    }
};

}  // namespace caustream::render
