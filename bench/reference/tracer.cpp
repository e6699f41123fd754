#include "bench/reference/tracer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <stdexcept>
#include <thread>

#include "bench/reference/glass.h"
#include "bench/reference/path.h"
#include "bench/reference/spectrum.h"

namespace caustream::tracer {

namespace {

constexpr int kHalves = 2;                    // fixed, whatever the threads: that keeps the bits
constexpr std::uint64_t kReportEvery = 4096;  // photons

// Roberts 2018, The Unreasonable Effectiveness of Quasirandom Sequences: R2 for the direction and R1, the golden ratio,
// for the wavelength. (R3 for all three has a worse projection on the directions: twice the error in every map.) Fixed
// point of 64 bits, so that it does not coarsen as it goes on.
class Sequence {
 public:
    explicit Sequence(int half) {
        // The halves start in different places of the cube, far apart for all its lattice.
        constexpr std::array<double, 3> kStart{0.5, 0.5, 0.5}, kOther{0.29289, 0.91421, 0.23607};
        for (std::size_t i = 0; i < 3; ++i) state_[i] = fixed(half == 0 ? kStart[i] : kOther[i]);
    }
    std::array<double, 3> next() {
        std::array<double, 3> place{};
        for (std::size_t i = 0; i < 3; ++i) {
            place[i] = std::ldexp(static_cast<double>(state_[i] >> 11), -53);
            state_[i] += step_[i];
        }
        return place;
    }

 private:
    static std::uint64_t fixed(double x) { return static_cast<std::uint64_t>(std::ldexp(x, 64)); }

    std::array<std::uint64_t, 3> state_{};
    std::array<std::uint64_t, 3> step_{fixed(0.7548776662466927), fixed(0.5698402909980532), fixed(0.6180339887498949)};
};

void check(const Settings& settings) {
    const auto require = [](bool holds, const char* what) {
        if (!holds) throw std::invalid_argument(what);
    };
    require(settings.photons >= kHalves, "a trace needs two photons at least");
    require(settings.maxInterfaces >= 1 && settings.maxInterfaces <= 256, "1 to 256 interfaces");
    require(settings.threads == 1 || settings.threads == 2, "1 or 2 threads");
    require(settings.continuousSamples >= 0 && settings.continuousSamples <= 4096, "0 to 4096 wavelengths a photon");
    require(settings.minWeight >= 0.0 && settings.minWeight < 1.0, "a least weight of 0 to 1");
    for (const Window& window : settings.windows) require(window.columns > 0 && window.rows > 0, "windows have cells");
    for (const MapView& map : settings.maps) require(map.size > 0, "maps have texels");
}

struct Shared {
    const World& world;
    const Settings& settings;
    const Surfaces& surfaces;
    const Emission& emission;
    const SpectrumSampler& spectrum;
    const Inside& start;
    std::atomic<std::uint64_t> done{0};
    std::atomic<bool> stop{false};
};

struct Half {
    Half(const World& world, const Settings& settings, const Surfaces& surfaces)
        : collector(world, settings, surfaces), ledgers(settings.wavelengthsNm.size()) {}

    Collector collector;
    std::vector<Ledger> ledgers;
    Ledger continuous;
    std::uint64_t hits = 0;
    double worstClosure = 0.0;
};

GlassAt glassAt(const Glass& glass, double nm) {
    const double perM = absorptionAt(glass.absorption, nm);
    return glass.mirror ? GlassAt{.reflectance = std::exp(-perM)} : GlassAt{indexAt(glass.dispersion, nm), perM};
}

std::vector<GlassAt> glassesAt(const World& world, double nm) {
    std::vector<GlassAt> glasses;
    for (const Glass& glass : world.glasses) glasses.push_back(glassAt(glass, nm));
    return glasses;
}

void traceHalf(Shared& shared, int which, Half& half, const Progress& progress) {
    const Settings& settings = shared.settings;
    const std::uint64_t photons = settings.photons / kHalves;
    const double fluxEach = shared.emission.extent() / static_cast<double>(photons);
    std::vector<std::vector<GlassAt>> glasses;
    std::vector<Carried> bands;
    for (const double nm : settings.wavelengthsNm) {
        bands.push_back({static_cast<int>(bands.size()), glm::dvec3(0.0), 0.0});
        glasses.push_back(glassesAt(shared.world, nm));
    }
    std::vector<GlassAt> sampled(shared.world.glasses.size());
    PathTracer path(shared.world, settings, shared.surfaces, half.collector);
    Sequence sequence(which);

    for (std::uint64_t i = 0; i < photons && fluxEach > 0.0; ++i) {
        if (i % kReportEvery == 0) {
            if (shared.stop) return;
            const std::uint64_t done = shared.done += i > 0 ? kReportEvery : 0;
            if (progress) progress(static_cast<double>(done) / static_cast<double>(photons * kHalves));
        }
        const auto [s, t, place] = sequence.next();
        const Ray ray = shared.emission.sample(s, t);
        const double flux = fluxEach * shared.emission.share(ray.direction);
        if (flux <= 0.0) continue;
        // What the light meets first is the same for all wavelengths; light that meets a receiver first is direct light.
        const Hit first = shared.surfaces.nearest(ray.origin, ray.direction, shared.start, -1);
        if (first.object < 0 || first.glass < 0) continue;
        ++half.hits;
        for (std::size_t band = 0; band < bands.size(); ++band) {
            path.follow(ray, first, shared.start, glasses[band], bands[band], flux, half.ledgers[band]);
        }
        for (std::size_t k = 0; k < shared.spectrum.count(); ++k) {
            const WavelengthSample sample = shared.spectrum.at(k, place);
            for (std::size_t g = 0; g < sampled.size(); ++g) {
                sampled[g] = glassAt(shared.world.glasses[g], sample.nm);
            }
            path.follow(ray, first, shared.start, sampled, {-1, sample.xyz, sample.share}, flux, half.continuous);
        }
    }
    half.worstClosure = path.worstClosure();
}

Ledger mean(const Ledger& a, const Ledger& b, double share) {
    const double s = 0.5 * share;
    return {s * (a.onCasters + b.onCasters),           s * (a.landed + b.landed),
            s * (a.absorbed + b.absorbed),             s * (a.mirrors + b.mirrors),
            s * (a.firstReflected + b.firstReflected),
            s * (a.belowThreshold + b.belowThreshold), s * (a.interfaceLimit + b.interfaceLimit),
            s * (a.escaped + b.escaped)};
}

void runHalves(Shared& shared, std::array<Half, kHalves>& halves, const Progress& progress) {
    if (shared.settings.threads == 1) {
        for (int which = 0; which < kHalves; ++which) traceHalf(shared, which, halves[static_cast<std::size_t>(which)], progress);
        return;
    }
    std::exception_ptr failed;   // of the other thread
    {
        const std::jthread other([&] {
            try {
                traceHalf(shared, 1, halves[1], {});
            } catch (...) {
                failed = std::current_exception();
            }
        });
        try {
            traceHalf(shared, 0, halves[0], progress);
        } catch (...) {
            shared.stop = true;
            throw;
        }
    }
    if (failed) std::rethrow_exception(failed);
}

}  // namespace

Result trace(const World& world, const Settings& settings, const Progress& progress) {
    check(settings);
    const auto start = std::chrono::steady_clock::now();
    const Surfaces surfaces(world);
    const Emission emission(world);
    const SpectrumSampler spectrum(world.light.spectrum, settings.observer, settings.continuousSamples);
    const bool somewhere = world.light.type != scene::LightType::Directional;
    const Inside inside = somewhere ? surfaces.around(world.light.position) : Inside{};

    Shared shared{world, settings, surfaces, emission, spectrum, inside};
    std::array<Half, kHalves> halves{Half(world, settings, surfaces), Half(world, settings, surfaces)};
    runHalves(shared, halves, progress);
    if (progress) progress(1.0);

    Result result;
    Collector::finish(halves[0].collector, halves[1].collector, result);
    for (std::size_t band = 0; band < settings.wavelengthsNm.size(); ++band) {
        result.ledgers.push_back(mean(halves[0].ledgers[band], halves[1].ledgers[band], 1.0));
    }
    const double share = spectrum.count() > 0 ? 1.0 / static_cast<double>(spectrum.count()) : 0.0;
    result.continuous = mean(halves[0].continuous, halves[1].continuous, share);
    result.worstClosure = std::max(halves[0].worstClosure, halves[1].worstClosure);
    result.extent = emission.extent();
    result.photons = settings.photons / kHalves * kHalves;
    result.hits = halves[0].hits + halves[1].hits;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

Difference difference(const float* a, const float* b, int columns, int rows) {
    double apart = 0, sumA = 0, sumB = 0, xA = 0, yA = 0, xB = 0, yB = 0, worst = 0;
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i, ++a, ++b) {
            const double here = static_cast<double>(*a), there = static_cast<double>(*b);
            apart += std::abs(here - there);
            worst = std::max(worst, std::abs(here - there));
            sumA += here, xA += here * i, yA += here * j;
            sumB += there, xB += there * i, yB += there * j;
        }
    }
    if (sumA == 0.0 && sumB == 0.0) return {0.0, 1.0, 0.0, 0.0};
    return {apart / sumB, sumA / sumB, std::hypot(xA / sumA - xB / sumB, yA / sumA - yB / sumB),
            worst * static_cast<double>(columns) * static_cast<double>(rows) / sumB};
}

}  // namespace caustream::tracer
