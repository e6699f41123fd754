#include "bench/reference/path.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numeric>

#include "bench/reference/glass.h"

namespace caustream::tracer {

PathTracer::PathTracer(const World& world, const Settings& settings, const Surfaces& surfaces, Collector& collector)
    : world_(world), settings_(settings), surfaces_(surfaces), collector_(collector), outside_{world.outsideIndex, 0.0} {
    for (const Body& body : world.bodies) glassOf_.push_back(body.glass);
    for (const Solid& solid : world.solids) glassOf_.push_back(solid.glass);
    const auto priority = [&](int object) {
        const int glass = glassOf_[static_cast<std::size_t>(object)];
        return glass < 0 ? 0 : world.glasses[static_cast<std::size_t>(glass)].priority;
    };
    std::vector<int> order(glassOf_.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, std::greater(), priority);
    rankOf_.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) rankOf_[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
    waiting_.reserve(64);
}

// Schmidt & Budge 2002, Simple Nested Dielectrics in Ray Traced Images. Between two media of one kind there is no surface:
// indices are equal where an object is met inside one of higher rank.
const GlassAt& PathTracer::at(const Inside& inside, const Photon& photon) const {
    if (inside.empty()) return outside_;
    const int there = *std::ranges::min_element(inside.objects(), {}, [&](int object) { return rankOf_[static_cast<std::size_t>(object)]; });
    return photon.glasses[static_cast<std::size_t>(glassOf_[static_cast<std::size_t>(there)])];
}

void PathTracer::push(const Branch& branch, Photon& photon) {
    if (branch.flux < photon.least) {
        photon.ledger.belowThreshold += branch.flux;
    } else {
        waiting_.push_back(branch);
    }
}

// Metal: Schlick 1994, An Inexpensive BRDF Model for Physically-based Rendering, from the reflectance at normal
// incidence to 1 at grazing; the rest stays there. What is inside what does not change.
void PathTracer::reflect(const Branch& branch, const Hit& hit, Photon& photon) {
    const double side = hit.entering ? 1.0 : -1.0;
    const auto thrownBy = [&](const glm::dvec3& normal) { return glm::normalize(branch.direction - 2.0 * glm::dot(branch.direction, normal) * normal); };
    const bool astray = side * glm::dot(thrownBy(hit.shading), hit.geometric) <= 0.0;
    const glm::dvec3& normal = astray ? hit.geometric : hit.shading;
    const double r = photon.glasses[static_cast<std::size_t>(hit.glass)].reflectance;
    const double grazing = 1.0 - std::min(std::abs(glm::dot(branch.direction, normal)), 1.0);

    Branch thrown = branch;
    thrown.point = branch.point + hit.distance * branch.direction;
    thrown.direction = thrownBy(normal);
    thrown.onSolid = std::max(hit.object - static_cast<int>(world_.bodies.size()), -1);
    thrown.surfaces = branch.surfaces + 1;
    thrown.flux = branch.flux * (r + (1.0 - r) * std::pow(grazing, 5.0));
    photon.ledger.mirrors += branch.flux - thrown.flux;
    if (thrown.flux > 0.0) push(thrown, photon);
}

// Splits at a surface of glass. Directions follow the interpolated normal; one that it would send to the wrong side of
// the surface follows the surface's own.
void PathTracer::cross(const Branch& branch, const Hit& hit, Photon& photon) {
    const auto solids = static_cast<int>(world_.bodies.size());
    Branch passed = branch;
    passed.point = branch.point + hit.distance * branch.direction;
    passed.onSolid = hit.object >= solids ? hit.object - solids : -1;
    passed.surfaces = branch.surfaces + 1;
    Branch thrown = passed;
    if (hit.entering) {
        passed.inside.enter(hit.object);
    } else {
        passed.inside.leave(hit.object);
    }
    const double from = at(branch.inside, photon).index, into = at(passed.inside, photon).index;
    const double side = hit.entering ? 1.0 : -1.0;
    Split split = meet(branch.direction, side * hit.shading, from, into);
    const double back = side * glm::dot(split.reflected, hit.geometric), through = -side * glm::dot(split.transmitted, hit.geometric);
    if (back <= 0.0 || (split.reflectance < 1.0 && through <= 0.0)) split = meet(branch.direction, side * hit.geometric, from, into);

    thrown.direction = split.reflected;
    thrown.flux = branch.flux * split.reflectance;
    passed.direction = split.transmitted;
    passed.flux = branch.flux - thrown.flux;
    if (branch.surfaces == 0 && hit.entering && branch.inside.empty() && !settings_.firstReflection) {
        photon.ledger.firstReflected += thrown.flux;
    } else if (thrown.flux > 0.0) {
        push(thrown, photon);
    }
    if (passed.flux > 0.0) push(passed, photon);
}

void PathTracer::run(Branch branch, Hit hit, bool hasHit, Photon& photon) {
    for (;;) {
        if (!hasHit) hit = surfaces_.nearest(branch.point, branch.direction, branch.inside, branch.onSolid);
        hasHit = false;
        Ledger& ledger = photon.ledger;
        if (hit.object < 0) {
            ledger.escaped += branch.flux;
        } else {
            if (const double perM = at(branch.inside, photon).perM; perM > 0.0) {
                const double absorbed = -branch.flux * std::expm1(-perM * hit.distance);
                ledger.absorbed += absorbed;
                branch.flux -= absorbed;
            }
            if (hit.glass < 0) {
                ledger.landed += branch.flux;
                collector_.land(branch.point + hit.distance * branch.direction, branch.direction, hit.geometric, photon.carried, branch.flux);
            } else if (branch.surfaces >= settings_.maxInterfaces) {
                ledger.interfaceLimit += branch.flux;
            } else if (world_.glasses[static_cast<std::size_t>(hit.glass)].mirror) {
                reflect(branch, hit, photon);
            } else {
                cross(branch, hit, photon);
            }
        }
        if (waiting_.empty()) return;
        branch = waiting_.back();
        waiting_.pop_back();
    }
}

void PathTracer::follow(const Ray& ray, const Hit& first, const Inside& start, const std::vector<GlassAt>& glasses,
                        const Carried& carried, double flux, Ledger& ledger) {
    Photon photon{glasses, carried, settings_.minWeight * flux, {}};
    run({ray.origin, ray.direction, flux, start}, first, true, photon);

    const Ledger& own = photon.ledger;
    const double booked = own.landed + own.absorbed + own.mirrors + own.firstReflected + own.belowThreshold + own.interfaceLimit + own.escaped;
    worstClosure_ = std::max(worstClosure_, std::abs(booked - flux) / flux);
    ledger.onCasters += flux;
    ledger.landed += own.landed;
    ledger.absorbed += own.absorbed;
    ledger.mirrors += own.mirrors;
    ledger.firstReflected += own.firstReflected;
    ledger.belowThreshold += own.belowThreshold;
    ledger.interfaceLimit += own.interfaceLimit;
    ledger.escaped += own.escaped;
}

}  // namespace caustream::tracer
