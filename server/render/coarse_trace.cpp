#include "render/coarse_trace.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <optional>

#include "error.h"
#include "optics/fresnel.h"

namespace caustream::render {

namespace {

struct Hit {
    float distance = 0.0f;
    glm::vec3 normal{0.0f};   // interpolated, unit
};

template <auto Release>
struct Releaser {
    template <class T>
    void operator()(T* pointer) const {
        Release(pointer);
    }
};
using Device = std::unique_ptr<RTCDeviceTy, Releaser<rtcReleaseDevice>>;
using Scene = std::unique_ptr<RTCSceneTy, Releaser<rtcReleaseScene>>;

}  // namespace

struct CoarseTrace::Impl {
    std::shared_ptr<const scene::Geometry> geometry;
    Device device{rtcNewDevice("threads=1")};
    Scene receivers;
    std::vector<Scene> casters;   // by object; null for receivers

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
        if (glm::dot(normal, normal) > 1e-12f) return Hit{ray.ray.tfar, glm::normalize(normal)};
        // Normals that cancel out between opposite ones: the triangle's own
        const glm::vec3 flat(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z);
        const float length = glm::length(flat);
        return length > 0.0f ? std::optional(Hit{ray.ray.tfar, flat / length}) : std::nullopt;
    }
};

float coneVersine(float halfAngleDeg) {
    const double sine = std::sin(0.5 * glm::radians(static_cast<double>(halfAngleDeg)));
    return static_cast<float>(2.0 * sine * sine);
}

float coneFalloff(const scene::Light& light, const glm::vec3& direction) {
    if (light.type != scene::LightType::Spot) return 1.0f;
    const glm::vec3 off = direction - light.direction;
    const float versine = 0.5f * glm::dot(off, off);
    const float inner = coneVersine(light.innerConeDeg), outer = coneVersine(light.outerConeDeg), ramp = outer - inner;
    if (ramp <= 1e-6f * outer) return versine <= outer ? 1.0f : 0.0f;
    const float t = glm::clamp((outer - versine) / ramp, 0.0f, 1.0f);
    return t * t;
}

CoarseTrace::CoarseTrace(const scene::Scene& scene) : impl_(std::make_unique<Impl>()) {
    if (!impl_->device) throw Error("Embree does not start; install libembree3-3 for this processor");
    impl_->geometry = scene.geometry;
    impl_->receivers.reset(rtcNewScene(impl_->device.get()));
    for (const scene::Object& object : scene.geometry->objects) {
        Scene& own = impl_->casters.emplace_back();
        if (scene.materials[static_cast<std::size_t>(object.material)].caster) {
            own.reset(rtcNewScene(impl_->device.get()));
            impl_->attach(own.get(), object);
            rtcCommitScene(own.get());
        } else {
            impl_->attach(impl_->receivers.get(), object);
        }
    }
    rtcCommitScene(impl_->receivers.get());
}

CoarseTrace::~CoarseTrace() = default;

std::vector<Landing> CoarseTrace::trace(const scene::Scene& scene, const scene::Light& light,
                                        const scene::Object& caster, const View& emission, int grid,
                                        const std::vector<double>& wavelengthsNm) const {
    const scene::Material& material = scene.materials[static_cast<std::size_t>(caster.material)];
    const RTCScene inside = impl_->casters[static_cast<std::size_t>(&caster - scene.geometry->objects.data())].get();
    const glm::mat4 toWorld = glm::affineInverse(emission.worldToView);
    const float skip = 1e-5f * caster.bounds.radius();   // leaves the surface just met

    std::vector<Landing> landings;
    for (int j = 0; j < grid; ++j) {
        for (int i = 0; i < grid; ++i) {
            const glm::vec2 xy = (glm::vec2(i + 0.5f, j + 0.5f) * (2.0f / grid) - 1.0f) * emission.halfExtent;
            const glm::vec3 origin = glm::vec3(toWorld * (emission.perspective ? glm::vec4(0, 0, 0, 1) : glm::vec4(xy, 0, 1)));
            const glm::vec3 direction =
                glm::normalize(glm::vec3(toWorld * (emission.perspective ? glm::vec4(xy, -1, 0) : glm::vec4(0, 0, -1, 0))));
            const float emitted = coneFalloff(light, direction);
            const auto entry = emitted > 0.0f ? impl_->intersect(inside, origin, direction, 0.0f) : std::nullopt;
            if (!entry || glm::dot(entry->normal, direction) >= 0.0f) continue;
            const glm::vec3 entryPoint = origin + entry->distance * direction;

            for (const double nm : wavelengthsNm) {
                const double eta = scene.outsideIndex / optics::refractiveIndex(material.dispersion, nm);
                const auto within = optics::refract(direction, entry->normal, eta);
                if (!within) continue;
                const auto exit = impl_->intersect(inside, entryPoint, glm::vec3(*within), skip);
                if (!exit || glm::dot(exit->normal, glm::vec3(*within)) <= 0.0f) continue;
                const auto out = optics::refract(*within, -glm::dvec3(exit->normal), 1.0 / eta);
                if (!out) continue;
                const glm::vec3 exitPoint = entryPoint + exit->distance * glm::vec3(*within);
                const auto landing = impl_->intersect(impl_->receivers.get(), exitPoint, glm::vec3(*out), 0.0f);
                if (!landing) continue;
                const double cosIn = -glm::dot(glm::dvec3(direction), glm::dvec3(entry->normal));
                const double cosOut = glm::dot(*within, glm::dvec3(exit->normal));
                const double passed = (1.0 - optics::fresnelDielectric(cosIn, eta)) *
                                      (1.0 - optics::fresnelDielectric(cosOut, 1.0 / eta));
                landings.push_back({exitPoint + landing->distance * glm::vec3(*out),
                                    emitted * static_cast<float>(passed), j * grid + i});
            }
        }
    }
    return landings;
}

}  // namespace caustream::render
