#include "bench/reference/path.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "bench/reference/glass.h"

namespace caustream::tracer {

PathTracer::PathTracer(const World& world, const Settings& settings, const Surfaces& surfaces, Collector& collector)
    : world_(world), settings_(settings), surfaces_(surfaces), collector_(collector), outside_{world.outsideIndex, 0.0} {
    for (const Body& body : world.bodies) glassOf_.push_back(body.glass);
    for (const Solid& solid : world.solids) glassOf_.push_back(solid.glass);
    waiting_.reserve(64);
}

const GlassAt& PathTracer::at(const Inside& inside, const Photon& photon) const {
    if (inside.empty()) return outside_;
    return photon.glasses[static_cast<std::size_t>(glassOf_[static_cast<std::size_t>(inside.innermost())])];
}

void PathTracer::push(const Branch& branch, Photon& photon) {
    if (branch.flux < photon.least) {
        photon.ledger.belowThreshold += branch.flux;
    } else {
        waiting_.push_back(branch);
    }
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
    const double booked = own.landed + own.absorbed + own.firstReflected + own.belowThreshold + own.interfaceLimit + own.escaped;
    worstClosure_ = std::max(worstClosure_, std::abs(booked - flux) / flux);
    ledger.onCasters += flux;
    ledger.landed += own.landed;
    ledger.absorbed += own.absorbed;
    ledger.firstReflected += own.firstReflected;
    ledger.belowThreshold += own.belowThreshold;
    ledger.interfaceLimit += own.interfaceLimit;
    ledger.escaped += own.escaped;
}

}  // namespace caustream::tracer
