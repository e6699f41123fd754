// One photon at one wavelength, through all its surfaces.
#pragma once
#include <vector>

#include "bench/reference/collector.h"
#include "bench/reference/emission.h"
#include "bench/reference/surfaces.h"
#include "bench/reference/tracer.h"

namespace caustream::tracer {

// A glass at one wavelength.
struct GlassAt {
    double index = 1.0, perM = 0.0;   // absorption in 1/m
    double reflectance = 0.0;         // of a mirror, at normal incidence
};

class PathTracer {
 public:
    PathTracer(const World& world, const Settings& settings, const Surfaces& surfaces, Collector& collector);

    // From the light to the glass it met first. `flux` is booked in `ledger`, which closes.
    void follow(const Ray& ray, const Hit& first, const Inside& start, const std::vector<GlassAt>& glasses,
                const Carried& carried, double flux, Ledger& ledger);

    double worstClosure() const { return worstClosure_; }

 private:
    struct Branch {
        glm::dvec3 point{0.0}, direction{0.0};
        double flux = 0.0;
        Inside inside;
        int surfaces = 0;      // met so far
        int onSolid = -1;      // where it starts
    };
    struct Photon {
        const std::vector<GlassAt>& glasses;
        const Carried& carried;
        double least;          // flux below which a branch is not followed
        Ledger ledger;
    };
    void run(Branch branch, Hit hit, bool hasHit, Photon& photon);
    void reflect(const Branch& branch, const Hit& hit, Photon& photon);
    void cross(const Branch& branch, const Hit& hit, Photon& photon);
    void push(const Branch& branch, Photon& photon);
    const GlassAt& at(const Inside& inside, const Photon& photon) const;

    const World& world_;
    const Settings& settings_;
    const Surfaces& surfaces_;
    Collector& collector_;
    GlassAt outside_;
    std::vector<int> glassOf_;       // of each object, bodies first
    std::vector<int> rankOf_;        // of each object, by priority: where several are, the lowest is what is there
    std::vector<Branch> waiting_;    // kept, so that no photon allocates
    double worstClosure_ = 0.0;
};

}  // namespace caustream::tracer
