// CoarseTrace::paths: the CPU's twin of photon_paths.comp, for a few hundred photons.
#include <algorithm>
#include <array>
#include <glm/gtc/matrix_inverse.hpp>

#include "optics/fresnel.h"
#include "render/coarse_trace_impl.h"

namespace caustream::render {

namespace {

constexpr double kLeast = 0.01;      // of a photon's flux: weaker branches do not move a view
constexpr int kMostBranches = 16;

// Numbers of the casters that light is in; the lowest, of highest priority, is the medium. Twin of interfaces.glsl.
struct Inside {
    std::array<int, 4> casters;
    Inside() { casters.fill(kNone); }
    static constexpr int kNone = std::numeric_limits<int>::max();
    int medium() const { return *std::min_element(casters.begin(), casters.end()); }
    Inside left(int caster) const {
        Inside out = *this;
        std::replace(out.casters.begin(), out.casters.end(), caster, kNone);
        return out;
    }
    Inside entered(int caster) const {
        Inside out = left(caster);
        *std::max_element(out.casters.begin(), out.casters.end()) = caster;
        return out;
    }
};

struct Branch {
    glm::vec3 origin, direction;
    double flux;
    Inside inside;
    int bounces;
};

}  // namespace

CoarseTrace::Paths CoarseTrace::paths(const scene::Scene& scene, const scene::Light& light, std::span<const ExactCaster> casters,
                                      std::size_t first, const View& emission, int grid, const std::vector<double>& wavelengthsNm,
                                      int bounces) const {
    const scene::Object* objects = scene.geometry->objects.data();
    const auto casterOf = [&](const scene::Object* object) {
        const auto index = static_cast<std::size_t>(object - objects);
        const auto at = std::find_if(casters.begin(), casters.end(), [&](const ExactCaster& c) { return c.object == index; });
        return at == casters.end() ? Inside::kNone : static_cast<int>(at - casters.begin());
    };
    const auto materialOf = [&](int caster) -> const scene::Material& {
        return scene.materials[static_cast<std::size_t>(objects[casters[static_cast<std::size_t>(caster)].object].material)];
    };
    const auto indexOf = [&](int medium, double nm) {
        return medium == Inside::kNone ? scene.outsideIndex : optics::refractiveIndex(materialOf(medium).dispersion, nm);
    };
    const float skip = 1e-5f * objects[casters[first].object].bounds.radius();   // leaves the surface just met
    const glm::mat4 toWorld = glm::affineInverse(emission.worldToView);
    Paths paths;
    std::vector<Landing>& landings = paths.landings;
    std::vector<Branch> waiting;

    // One branch's next surface; what goes on from there waits its turn.
    const auto advance = [&](const Branch& now, bool start, double least, double nm, int photon) {
        const auto hit = impl_->intersect(impl_->all.get(), now.origin, now.direction, start ? 0.0f : skip);
        if (!hit) return;
        const int caster = casterOf(hit->object);
        const glm::vec3 at = now.origin + hit->distance * now.direction;
        const bool glass = caster == Inside::kNone && scene.materials[static_cast<std::size_t>(hit->object->material)].caster;
        if (start && caster != static_cast<int>(first)) return;
        if (start && nm == wavelengthsNm.front()) paths.met += 1.0 / (grid * grid);
        if (glass) {   // of the outside's index
            waiting.push_back({at, now.direction, now.flux, now.inside, now.bounces});
            return;
        }
        if (caster == Inside::kNone) {
            landings.push_back({at, static_cast<float>(now.flux), photon});
            return;
        }
        const bool enters = glm::dot(now.direction, hit->geometric) < 0.0f;
        glm::dvec3 against = enters ? hit->normal : -hit->normal;
        const glm::dvec3 direction = now.direction;
        if (glm::dot(direction, against) >= 0.0) against = enters ? hit->geometric : -hit->geometric;
        if (casters[static_cast<std::size_t>(caster)].mirror) {
            if (now.bounces < bounces) waiting.push_back({at, glm::reflect(direction, against), now.flux, now.inside, now.bounces + 1});
            return;
        }
        const Inside before = enters ? now.inside.left(caster) : now.inside.entered(caster);
        const Inside beyond = enters ? now.inside.entered(caster) : now.inside.left(caster);
        if (before.medium() == beyond.medium()) {
            waiting.push_back({at, now.direction, now.flux, beyond, now.bounces});
            return;
        }
        const double eta = indexOf(before.medium(), nm) / indexOf(beyond.medium(), nm);
        const double reflectance = optics::fresnelDielectric(-glm::dot(direction, against), eta);
        const auto through = optics::refract(direction, against, eta);
        if (through && now.flux * (1.0 - reflectance) > least) {
            waiting.push_back({at, glm::vec3(*through), now.flux * (1.0 - reflectance), beyond, now.bounces});
        }
        if (!start && now.flux * reflectance > least && now.bounces < bounces) {
            waiting.push_back({at, glm::reflect(direction, against), now.flux * reflectance, now.inside, now.bounces + 1});
        }
    };

    for (int photon = 0; photon < grid * grid; ++photon) {
        const glm::vec2 place = glm::vec2(photon % grid, photon / grid) + 0.5f;
        const glm::vec2 xy = (place * (2.0f / static_cast<float>(grid)) - 1.0f) * emission.halfExtent;
        const glm::vec3 origin = glm::vec3(toWorld * (emission.perspective ? glm::vec4(0, 0, 0, 1) : glm::vec4(xy, 0, 1)));
        const glm::vec3 direction = glm::normalize(glm::vec3(toWorld * (emission.perspective ? glm::vec4(xy, -1, 0) : glm::vec4(0, 0, -1, 0))));
        const double emitted = static_cast<double>(coneFalloff(light, direction));
        for (const double nm : wavelengthsNm) {
            if (emitted <= 0.0) break;
            waiting.assign(1, {origin, direction, emitted, {}, 0});
            bool start = true;
            for (int steps = 0; !waiting.empty() && steps < 8 * (bounces + 4); ++steps) {
                const Branch now = waiting.back();
                waiting.pop_back();
                if (waiting.size() < kMostBranches) advance(now, start, kLeast * emitted, nm, photon);
                start = false;
            }
        }
    }
    return paths;
}

}  // namespace caustream::render
