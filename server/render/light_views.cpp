#include "render/light_views.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <utility>
#include <vector>

namespace caustream::render {

namespace {

constexpr float kWidestTangent = 1.732f;   // 120 degrees across: beyond it texels say little
constexpr float kNearShare = 0.01f;        // of the distance to what a view is for; nearer things are the lamp's own
constexpr float kTurnedTangent = 1.2f;     // 100 degrees across: the published view is not turned beyond it

struct Rect {
    glm::vec2 min{1e30f}, max{-1e30f};
    bool empty() const { return min.x >= max.x || min.y >= max.y; }
    void add(const glm::vec2& p) { min = glm::min(min, p), max = glm::max(max, p); }
    glm::vec2 centre() const { return 0.5f * (min + max); }
    glm::vec2 half() const { return 0.5f * (max - min); }
};

bool parallel(const scene::Light& light) { return light.type == scene::LightType::Directional; }

// How far before and behind the point it looks through a parallel view reaches, m.
struct Span {
    float before, behind;
};
Span wholeScene(const scene::Scene& scene) {
    const float reach = std::max(scene.geometry->bounds.radius(), 1e-6f);
    return {3.0f * reach, 3.0f * reach};
}
// Just the caster: in a wide scene, a view from outside of it would have few digits left for a small caster.
Span around(const scene::Object& caster) {
    const float reach = 2.0f * std::max(caster.bounds.radius(), 1e-6f);
    return {reach, reach};
}

// View of the light along `forward`, through `through`; a directional light looks from `span.before` before it.
View frame(const scene::Scene& scene, const scene::Light& light, const glm::vec3& through, const Span& span) {
    View view;
    view.perspective = !parallel(light);
    const float reach = std::max(scene.geometry->bounds.radius(), 1e-6f);
    if (view.perspective) {
        const glm::vec3 away = through - light.position;
        const float distance = glm::length(away);
        const glm::vec3 forward = distance > 1e-6f * reach ? away / distance : light.direction;
        view.worldToView = lookAlong(light.position, forward, glm::vec3(0, 1, 0));
        view.nearM = kNearShare * std::max(distance, 1e-3f * reach);
    } else {
        view.worldToView = lookAlong(through - span.before * light.direction, light.direction, glm::vec3(0, 1, 0));
        view.nearM = 0.0f;
    }
    view.farM = view.perspective ? 6.0f * reach : span.before + span.behind;
    return view;
}

// Image coordinates of a view-space point: tangents, or metres. False behind the light.
bool project(const View& view, const glm::vec3& p, glm::vec2& out) {
    if (!view.perspective) {
        out = glm::vec2(p);
        return true;
    }
    if (-p.z <= 1e-6f * glm::length(p) || p.z >= 0.0f) return false;
    out = glm::vec2(p) / -p.z;
    return true;
}

// Whether the caster's bounding sphere lies beside the light's cone.
bool outsideCone(const scene::Light& light, const scene::Bounds& caster) {
    if (light.type != scene::LightType::Spot) return false;
    const glm::vec3 to = caster.centre() - light.position;
    const float distance = glm::length(to), radius = caster.radius();
    if (distance <= radius) return false;
    const float angle = std::acos(glm::clamp(glm::dot(to / distance, light.direction), -1.0f, 1.0f));
    return angle > glm::radians(light.outerConeDeg) + std::asin(radius / distance) + 1e-3f;
}

// Where the caster's vertices lie in the view's image.
Rect vertexRect(const scene::Scene& scene, const scene::Object& caster, const View& view) {
    Rect rect;
    const auto& geometry = *scene.geometry;
    for (std::uint32_t i = 0; i < caster.indexCount; ++i) {
        glm::vec2 p;
        if (project(view, view.toView(geometry.vertices[geometry.indices[caster.firstIndex + i]].position), p)) {
            rect.add(p);
        } else {
            rect.add(glm::vec2(kWidestTangent)), rect.add(glm::vec2(-kWidestTangent));
        }
    }
    if (view.perspective) {
        rect.min = glm::max(rect.min, glm::vec2(-kWidestTangent));
        rect.max = glm::min(rect.max, glm::vec2(kWidestTangent));
    }
    return rect;
}

// The cone's outline in the view's image; everything when part of it is behind the view.
Rect coneRect(const scene::Light& light, const View& view) {
    const Rect everything{glm::vec2(-1e30f), glm::vec2(1e30f)};
    if (light.type != scene::LightType::Spot) return everything;
    const float angle = glm::radians(light.outerConeDeg);
    const glm::mat4 cone = lookAlong(glm::vec3(0.0f), light.direction, glm::vec3(0, 1, 0));
    Rect rect;
    constexpr int kSamples = 64;
    for (int i = 0; i < kSamples; ++i) {
        const float turn = glm::two_pi<float>() * (i + 0.5f) / kSamples;
        const glm::vec3 inCone(std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), -std::cos(angle));
        const glm::vec3 inView = glm::mat3(view.worldToView) * (glm::transpose(glm::mat3(cone)) * inCone);
        glm::vec2 p;
        if (inView.z > -0.05f || !project(view, inView, p)) return everything;
        rect.add(p);
    }
    const glm::vec2 slack = 0.003f * rect.half();   // the polygon of samples lies inside the ellipse
    rect.min -= slack, rect.max += slack;
    return rect;
}

// Moves the view's axis into the middle of `rect`, given in its image.
View recentre(const scene::Scene& scene, const scene::Light& light, const View& view, const Rect& rect, float distance, const Span& span) {
    const glm::vec2 c = rect.centre();
    const glm::vec4 through = view.perspective ? glm::vec4(c * distance, -distance, 1) : glm::vec4(c, -distance, 1);
    return frame(scene, light, glm::vec3(glm::affineInverse(view.worldToView) * through), span);
}

glm::vec2 halfExtentAround(const Rect& rect) {
    return glm::max(glm::max(glm::abs(rect.min), glm::abs(rect.max)), glm::vec2(1e-6f));
}

// Turns the view about its axis.
View rolled(View view, float angle) {
    view.worldToView = glm::rotate(glm::mat4(1.0f), angle, glm::vec3(0, 0, 1)) * view.worldToView;
    return view;
}

// Nothing of the caster is nearer than the near plane, however close the light stands to it. A layer value is near / z in
// float: a near plane that is near costs no digits.
View reachingTo(const scene::Scene& scene, const scene::Object& caster, View view) {
    if (!view.perspective) return view;
    float nearest = 2.0f * view.nearM;
    const auto& geometry = *scene.geometry;
    for (std::uint32_t i = 0; i < caster.indexCount; ++i) {
        nearest = std::min(nearest, -view.toView(geometry.vertices[geometry.indices[caster.firstIndex + i]].position).z);
    }
    view.nearM = std::max(0.5f * nearest, 1e-4f * view.nearM);
    return view;
}

// Where landings lie in a view's image, in order along each axis: the value and the flux up to and with it.
struct Spread {
    std::vector<std::pair<float, double>> x, y;
};

void sumUp(std::vector<std::pair<float, double>>& valueAndFlux) {
    std::sort(valueAndFlux.begin(), valueAndFlux.end());
    double sum = 0.0;
    for (auto& [value, flux] : valueAndFlux) sum += flux, flux = sum;
}

Spread spreadOf(const View& view, std::span<const Landing> landings) {
    Spread spread;
    for (const Landing& landing : landings) {
        glm::vec2 p;
        if (!project(view, view.toView(landing.position), p)) continue;
        if (view.perspective && std::max(std::abs(p.x), std::abs(p.y)) > kWidestTangent) continue;
        spread.x.emplace_back(p.x, landing.flux);
        spread.y.emplace_back(p.y, landing.flux);
    }
    sumUp(spread.x), sumUp(spread.y);
    return spread;
}

// The range of one image coordinate that leaves `share` of the flux out at either end.
glm::vec2 quantileRange(const std::vector<std::pair<float, double>>& valueAndSum, double share) {
    const double total = valueAndSum.back().second;
    const auto low = std::find_if(valueAndSum.begin(), valueAndSum.end(), [&](const auto& at) { return at.second > share * total; });
    const auto high = std::find_if(valueAndSum.begin(), valueAndSum.end(), [&](const auto& at) { return at.second >= (1.0 - share) * total; });
    return {low == valueAndSum.end() ? valueAndSum.front().first : low->first, high == valueAndSum.end() ? valueAndSum.back().first : high->first};
}

// Where the landings lie in the view's image, less the left-out share. Empty when none is in front of the light.
Rect landingRect(const Spread& spread, double leftOut) {
    if (spread.x.empty()) return {};
    const glm::vec2 rangeX = quantileRange(spread.x, leftOut / 4.0), rangeY = quantileRange(spread.y, leftOut / 4.0);
    return {glm::vec2(rangeX.x, rangeY.x), glm::vec2(rangeX.y, rangeY.y)};
}

// The corners of one view of the light, in the image of another.
void addCorners(const View& of, const View& view, Rect& rect) {
    const glm::mat4 toWorld = glm::affineInverse(of.worldToView);
    for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(-1, 1), glm::vec2(1, 1)}) {
        glm::vec2 p;
        if (project(view, view.toView(glm::vec3(toWorld * glm::vec4(corner * of.halfExtent, -1, 1))), p)) rect.add(p);
    }
}

// Variance of the landings' depth over its mean's square.
float depthSpread(const View& view, std::span<const Landing> landings) {
    float flux = 0.0f, sum = 0.0f, squares = 0.0f;
    for (const Landing& landing : landings) {
        const float z = -view.toView(landing.position).z;
        flux += landing.flux, sum += landing.flux * z, squares += landing.flux * z * z;
    }
    return flux * squares / std::max(sum * sum, 1e-30f) - 1.0f;
}

// From before the casters to well beyond where a coarse trace landed, but no farther than the scene reaches.
Span aroundLandings(const scene::Scene& scene, const scene::Light& light, std::span<const Landing> landings, const glm::vec3& mean) {
    const scene::Bounds& casters = scene.geometry->casterBounds.empty() ? scene.geometry->bounds : scene.geometry->casterBounds;
    float before = glm::dot(mean - casters.centre(), light.direction), behind = 0.0f;
    for (const Landing& landing : landings) {
        const float along = glm::dot(landing.position - mean, light.direction);
        before = std::max(before, -along), behind = std::max(behind, along);
    }
    const Span whole = wholeScene(scene);
    const float slack = 2.0f * std::max(casters.radius(), 1e-6f);
    return {std::min(before + slack, whole.before), std::min(4.0f * behind + before + slack, whole.behind)};
}

}  // namespace

std::optional<View> emissionView(const scene::Scene& scene, const scene::Light& light, const scene::Object& caster) {
    if (outsideCone(light, caster.bounds)) return std::nullopt;
    const Span span = around(caster);
    View view = frame(scene, light, caster.bounds.centre(), span);
    for (int pass = 0;; ++pass) {
        Rect rect = vertexRect(scene, caster, view);
        const Rect cone = coneRect(light, view);
        rect.min = glm::max(rect.min, cone.min), rect.max = glm::min(rect.max, cone.max);
        if (rect.empty()) return std::nullopt;
        if (pass == 2) {
            view.halfExtent = halfExtentAround(rect);
            return reachingTo(scene, caster, view);
        }
        view = recentre(scene, light, view, rect, std::max(-view.toView(caster.bounds.centre()).z, view.nearM), span);
    }
}

View backView(const scene::Scene& scene, const scene::Light& light, const scene::Object& caster) {
    View view = frame(scene, light, caster.bounds.centre(), around(caster));
    view.halfExtent = 1.02f * halfExtentAround(vertexRect(scene, caster, view));
    return reachingTo(scene, caster, view);
}

std::optional<MapViews> mapViews(const scene::Scene& scene, const scene::Light& light, std::span<const Landing> landings,
                                 std::span<const double> leftOutShares, double outerWidth) {
    glm::vec3 mean(0.0f);
    float flux = 0.0f;
    for (const Landing& landing : landings) mean += landing.flux * landing.position, flux += landing.flux;
    if (!(flux > 0.0f)) return std::nullopt;
    mean /= flux;

    // The roll whose rectangle is smallest, and the share outside it that makes texels narrowest for all light together;
    // then its middle on the axis.
    const Span span = aroundLandings(scene, light, landings, mean);
    const View upright = frame(scene, light, mean, span);
    const float distance = std::max(-upright.toView(mean).z, upright.nearM);
    double bestWidth = std::numeric_limits<double>::max(), leftOut = 0.0;
    float roll = 0.0f;
    Rect best;
    constexpr int kRolls = 12;
    for (int i = 0; i < kRolls; ++i) {
        const float angle = glm::half_pi<float>() * static_cast<float>(i) / kRolls;
        const Spread spread = spreadOf(rolled(upright, angle), landings);
        const glm::vec2 all = landingRect(spread, 0.0).half();
        for (const double share : leftOutShares) {
            const Rect rect = landingRect(spread, share);
            const glm::vec2 size = rect.half();
            if (rect.min.x > rect.max.x) continue;
            const double width = (1.0 - share) * std::sqrt(static_cast<double>(size.x) * static_cast<double>(size.y)) +
                                 share * outerWidth * std::sqrt(static_cast<double>(all.x) * static_cast<double>(all.y));
            if (width < bestWidth) bestWidth = width, leftOut = share, roll = angle, best = rect;
        }
    }
    if (bestWidth == std::numeric_limits<double>::max()) return std::nullopt;
    MapViews views;
    views.inner = rolled(recentre(scene, light, rolled(upright, roll), best, distance, span), roll);
    const Spread spread = spreadOf(views.inner, landings);
    const Rect rect = landingRect(spread, leftOut), all = landingRect(spread, 0.0);
    if (rect.min.x > rect.max.x) return std::nullopt;

    // A few hundred photons end before the caustic does: half a step of their grid wider.
    constexpr float kMargin = 1.05f;
    const float least = 1e-4f * (views.inner.perspective ? 1.0f : span.before);
    const float widest = views.inner.perspective ? kWidestTangent : 3.0f * scene.geometry->bounds.radius();
    views.inner.halfExtent = glm::clamp(kMargin * halfExtentAround(rect), glm::vec2(least), glm::vec2(widest));
    views.landing = mean;
    views.outer = views.inner;
    views.outer.halfExtent = glm::min(glm::max(4.0f * views.inner.halfExtent, 1.1f * halfExtentAround(all)), glm::vec2(widest));
    return views;
}

View shadowView(const scene::Scene& scene, const scene::Light& light) {
    const scene::Bounds& casters = scene.geometry->casterBounds;
    const scene::Bounds& target = casters.empty() ? scene.geometry->bounds : casters;
    if (light.type == scene::LightType::Spot) {
        View view = frame(scene, light, light.position + light.direction * std::max(glm::length(target.centre() - light.position), 1e-3f * target.radius()),
                          wholeScene(scene));
        view.halfExtent = glm::vec2(std::min(std::tan(glm::radians(std::min(light.outerConeDeg, 80.0f))) * 1.01f, kWidestTangent));
        return view;
    }
    View view = frame(scene, light, target.centre(), wholeScene(scene));
    view.halfExtent = glm::vec2(view.perspective ? 1.2f : 1.01f * scene.geometry->bounds.radius());
    if (!view.perspective) view.worldToView = frame(scene, light, scene.geometry->bounds.centre(), wholeScene(scene)).worldToView;
    return view;
}

View wholeView(const scene::Scene& scene, const scene::Light& light, std::span<const Landing> landings,
               std::span<const View> emissions) {
    const View cone = shadowView(scene, light);
    glm::vec3 mean(0.0f);
    float all = 0.0f, held = 0.0f;
    for (const Landing& landing : landings) {
        glm::vec2 p;
        all += landing.flux;
        mean += landing.flux * landing.position;
        const bool ahead = project(cone, cone.toView(landing.position), p);
        if (ahead && std::max(std::abs(p.x), std::abs(p.y)) <= cone.halfExtent.x) held += landing.flux;
    }
    if (held >= 0.9f * all) return cone;

    // Away from the casters, from the caustic's middle on, to where its depth changes least.
    const glm::vec3 along = mean / all - light.position;
    const glm::vec3 turn = glm::cross(light.direction, along);
    const int turns = cone.perspective && glm::dot(turn, turn) > 0.0f ? 12 : 0;
    View best = cone;
    float leastSpread = std::numeric_limits<float>::max();
    for (int i = 0; i <= turns; ++i) {
        const glm::mat3 turned(i > 0 ? glm::rotate(glm::mat4(1.0f), glm::radians(5.0f * static_cast<float>(i)), turn) : glm::mat4(1.0f));
        View view = frame(scene, light, cone.perspective ? light.position + turned * along : mean / all, wholeScene(scene));
        Rect rect = landingRect(spreadOf(view, landings), kLeftOut[0]);
        for (const View& emission : emissions) addCorners(emission, view, rect);
        const glm::vec2 half = 1.05f * halfExtentAround(rect);
        const float reach = std::max(half.x, half.y);
        if (i > 0 && reach > kTurnedTangent) break;
        view.halfExtent = glm::vec2(std::min(reach, view.perspective ? kWidestTangent : 3.0f * scene.geometry->bounds.radius()));
        view.nearM = std::min(view.nearM, cone.nearM);
        if (const float spread = depthSpread(view, landings); spread < leastSpread) leastSpread = spread, best = view;
    }
    return best;
}

}  // namespace caustream::render
