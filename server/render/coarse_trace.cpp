#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/trigonometric.hpp>

#include "error.h"
#include "optics/fresnel.h"
#include "render/coarse_trace_impl.h"

namespace caustream::render {

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
    impl_->all.reset(rtcNewScene(impl_->device.get()));
    for (const scene::Object& object : scene.geometry->objects) {
        Impl::Scene& own = impl_->casters.emplace_back();
        const scene::Material& material = scene.materials[static_cast<std::size_t>(object.material)];
        if (!(material.caster && material.thinWalled)) impl_->attach(impl_->all.get(), object);
        if (material.caster) {
            own.reset(rtcNewScene(impl_->device.get()));
            impl_->attach(own.get(), object);
            rtcCommitScene(own.get());
        } else {
            impl_->attach(impl_->receivers.get(), object);
        }
    }
    rtcCommitScene(impl_->receivers.get());
    rtcCommitScene(impl_->all.get());
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
