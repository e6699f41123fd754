#include "render/choose_transport.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace caustream::render {

namespace {

// Steps wide enough that neighbours differ visibly, so that small changes of the light do not change the choice.
constexpr std::array kGrids = {64, 90, 128, 180, 256, 360, 512, 720, 1024};
constexpr std::array kMapSizes = {128, 256, 512, 1024};
constexpr int kFewSteps = 4, kManySteps = 8;   // Newton steps to the exit

// Where a choice that was made is kept: it costs so much more than the budget, errs so much more than the best.
constexpr double kSlackCost = 1.1, kSlackError = 1.15, kSlackSaving = 1.25;

constexpr std::size_t kRecent = 7, kScenes = 8;
constexpr std::size_t kTrusted = 3;    // measurements of a kind of spectrum that are believed whatever the others say
constexpr double kDoubt = 2.0;         // fewer may say this many times what the others make one expect

// No target is worth a slower frame: a server draws for several viewers.
constexpr double kMostMs = 2000.0;

// First guesses, replaced by the first frame: a sphere on two cores with software rendering.
constexpr double kFixedMs = 5.0, kRestMs = 15.0, kTexelNs = 12.0, kPhotonNs = 300.0;
constexpr double kPhotons = 0.75;      // of the grid's texels that hold the caster
constexpr ErrorEstimate kError{.sampling = 0.06, .resolution = 0.04};

// Sampling error falls with the photons a texel to this power: from grid 128 to 512 by .15 to .6 on the six scenes.
constexpr double kExponent = 0.35, kLeastExponent = 0.05, kMostExponent = 0.6;
// Spectral error with the number of exact wavelengths: 1 to 21 on the prism; a continuous one's over one wavelength's.
constexpr double kSpectralExponent = 0.8, kContinuousShare = 0.02;
constexpr double kOneWavelength = 0.25;   // where no exact ones were seen yet

// Cost of a photon at so many wavelengths over that at one, where it was not measured.
double relativeCost(int wavelengths) { return wavelengths == kContinuous ? 2.0 : 1.0 + 0.15 * (wavelengths - 1); }

// Relative L1 to 16 steps, in the mean of the six scenes, and cost of a photon over that at kFewSteps. Two steps err by
// .06 and save a tenth: no photons are cheap enough to make good for it.
double stepsError(int backSteps) { return backSteps < kManySteps ? 0.008 : 0.001; }
double stepsCost(int backSteps) { return backSteps < kManySteps ? 1.0 : 1.05; }

double texelsOf(int mapSize) { return static_cast<double>(mapSize) * mapSize; }

double stageMs(const FrameStats& stats, std::initializer_list<const char*> passes) {
    double ms = 0.0;
    for (const StageTime& stage : stats.stages) {
        if (std::find(passes.begin(), passes.end(), stage.pass) != passes.end()) ms += stage.ms;
    }
    return ms;
}

std::string describe(const Configuration& c) {
    const std::string spectrum = c.wavelengths == kContinuous ? "continuous" : std::to_string(c.wavelengths) + (c.wavelengths == 1 ? " wavelength" : " wavelengths");
    char numbers[64];
    std::snprintf(numbers, sizeof numbers, ": about %.1f%% in %.0f ms", 100.0 * c.error, c.ms);
    return "photon grid " + std::to_string(c.photonGrid) + ", map " + std::to_string(c.mapSize) + ", " + spectrum +
           ", " + std::to_string(c.backSteps) + " back steps" + numbers;
}

std::string number(const char* format, double value) {
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

}  // namespace

bool Configuration::sameAs(const Configuration& o) const {
    return photonGrid == o.photonGrid && mapSize == o.mapSize && wavelengths == o.wavelengths && backSteps == o.backSteps;
}

std::vector<Configuration> paretoFront(std::vector<Configuration> all) {
    std::sort(all.begin(), all.end(), [](const Configuration& a, const Configuration& b) {
        return a.ms != b.ms ? a.ms < b.ms : a.error < b.error;
    });
    std::vector<Configuration> front;
    for (const Configuration& next : all) {
        if (front.empty() || next.error < front.back().error) front.push_back(next);
    }
    return front;
}

Choice choose(std::span<const Configuration> front, const Transport& wanted, const std::optional<Configuration>& previous) {
    const bool budget = wanted.budgetMs > 0.0;
    const auto cheap = [&](const Configuration& c, double slack) { return c.ms <= slack * wanted.budgetMs; };
    const auto accurate = [&](const Configuration& c, double slack) { return c.error <= slack * wanted.targetError; };

    // The last that is cheap enough, or the first that is accurate enough.
    Choice choice;
    if (budget) {
        const auto after = std::find_if_not(front.begin(), front.end(), [&](const Configuration& c) { return cheap(c, 1.0); });
        choice.met = after != front.begin();
        choice.configuration = choice.met ? *std::prev(after) : front.front();
    } else {
        const auto slow = std::find_if(std::next(front.begin()), front.end(), [](const Configuration& c) { return c.ms > kMostMs; });
        front = front.first(static_cast<std::size_t>(slow - front.begin()));
        const auto found = std::find_if(front.begin(), front.end(), [&](const Configuration& c) { return accurate(c, 1.0); });
        choice.met = found != front.end();
        choice.configuration = choice.met ? *found : front.back();
    }

    const auto kept = std::find_if(front.begin(), front.end(), [&](const Configuration& c) { return previous && c.sameAs(*previous); });
    if (choice.met && kept != front.end()) {
        const bool good = budget ? cheap(*kept, kSlackCost) && kept->error <= kSlackError * choice.configuration.error
                                 : accurate(*kept, kSlackCost) && kept->ms <= kSlackSaving * choice.configuration.ms;
        if (good) choice.configuration = *kept;
    }

    const std::string asked = budget ? number("%g ms", wanted.budgetMs) : number("%g%%", 100.0 * wanted.targetError);
    choice.sentence = describe(choice.configuration) +
                      (budget ? choice.met ? ", the best that " + asked + " allow" : ", the fastest there is: nothing keeps within " + asked
                              : choice.met ? ", the fastest that reaches " + asked : ", the best there is within " + number("%g ms", kMostMs) + ": nothing reaches " + asked);
    return choice;
}

void Recent::add(double value) {
    values_.push_back(value);
    if (values_.size() > kRecent) values_.pop_front();
}

double Recent::medianOr(double fallback) const {
    if (values_.empty()) return fallback;
    std::vector<double> sorted(values_.begin(), values_.end());
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
}

void Calibration::learnCost(const Transport& transport, const FrameStats& stats, bool light) {
    const double photons = stageMs(stats, {"photon_trace"}), texels = stageMs(stats, {"map_resolve", "spectral_step", "gap_fill"});
    const double fixed = stageMs(stats, {"caster_layers", "photon_list", "receiver_depth"});
    if (light && stats.photons > 0) {
        // A driver compiles a kind of spectrum when it is first drawn: that time says nothing.
        const auto known = photonNs_.find(transport.wavelengths);
        if (known == photonNs_.end()) photonNs_[transport.wavelengths];
        else known->second.add(1e6 * photons / (stepsCost(transport.backSteps) * stats.photons));
        texelNs_.add(1e6 * texels / texelsOf(transport.mapSize));
        fixedMs_.add(fixed);
    }
    restMs_.add(std::max(0.0, stats.renderMs - photons - texels - fixed));
}

void Calibration::learnError(const void* scene, const Transport& transport, const ErrorEstimate& error, std::uint32_t photons) {
    auto found = std::find_if(scenes_.begin(), scenes_.end(), [&](const SceneError& s) { return s.scene == scene; });
    SceneError next{scene, error, static_cast<double>(photons), transport.photonGrid, transport.mapSize, kExponent, {}, {}};
    if (found != scenes_.end()) {
        // What the sampling error did when the density changed, if it changed enough to tell.
        next.exponent = found->exponent, next.oneWavelength = found->oneWavelength, next.continuous = found->continuous;
        const double density = std::log((next.photons / texelsOf(next.mapSize)) / (found->photons / texelsOf(found->mapSize)));
        if (std::abs(density) > 0.5 && error.sampling > 0.0 && found->error.sampling > 0.0) {
            const double measured = -std::log(error.sampling / found->error.sampling) / density;
            next.exponent = std::clamp(0.5 * (found->exponent + measured), kLeastExponent, kMostExponent);
        }
        scenes_.erase(found);
    }
    if (transport.wavelengths == kContinuous) next.continuous = error.spectral;
    else next.oneWavelength = error.spectral * std::pow(transport.wavelengths, kSpectralExponent);
    scenes_.push_front(next);
    if (scenes_.size() > kScenes) scenes_.pop_back();
}

double Calibration::photonNs(int wavelengths) const {
    // What the kind that was seen most often makes one expect
    double expected = kPhotonNs * relativeCost(wavelengths);
    std::size_t most = 0;
    for (const auto& [count, ns] : photonNs_) {
        if (count == wavelengths || ns.size() <= most) continue;
        most = ns.size();
        expected = ns.medianOr(0.0) * relativeCost(wavelengths) / relativeCost(count);
    }
    const auto own = photonNs_.find(wavelengths);
    if (own == photonNs_.end() || own->second.size() == 0) return expected;
    const double measured = own->second.medianOr(0.0);
    // One slow frame of a kind that is then never chosen again would not be corrected.
    return own->second.size() < kTrusted && most > 0 ? std::min(measured, kDoubt * expected) : measured;
}

Configuration Calibration::expected(Configuration c, const SceneError& known) const {
    const double photons = known.photons * std::pow(static_cast<double>(c.photonGrid) / known.photonGrid, 2.0);
    const double texels = texelsOf(c.mapSize), knownTexels = texelsOf(known.mapSize);
    c.ms = fixedMs_.medianOr(kFixedMs) + restMs_.medianOr(kRestMs) +
           1e-6 * (photons * photonNs(c.wavelengths) * stepsCost(c.backSteps) + texels * texelNs_.medianOr(kTexelNs));
    const double density = (photons / texels) / (known.photons / knownTexels);
    const double sampling = known.error.sampling * std::pow(density, -known.exponent);
    const double one = known.oneWavelength.value_or(kOneWavelength);
    const double spectral = c.wavelengths == kContinuous ? known.continuous.value_or(kContinuousShare * one)
                                                         : one * std::pow(c.wavelengths, -kSpectralExponent);
    const double resolution = known.error.resolution * std::sqrt(knownTexels / texels);
    c.error = std::min(2.0, std::hypot(std::hypot(sampling, spectral), std::hypot(resolution, stepsError(c.backSteps))));
    return c;
}

std::vector<Configuration> Calibration::configurations(const void* scene, const Transport& wanted, bool dispersive, Kept kept) const {
    SceneError known{scene, kError, kPhotons * texelsOf(256), 256, 512, kExponent, {}, {}};
    const auto found = std::find_if(scenes_.begin(), scenes_.end(), [&](const SceneError& s) { return s.scene == scene; });
    if (found != scenes_.end()) known = *found;
    if (!dispersive) known.oneWavelength = 0.0;

    std::vector<int> spectra = {1};
    if (kept.wavelengths) spectra = {wanted.wavelengths};
    else if (dispersive) spectra = {1, 7, kContinuous};
    std::vector<int> sizes(kMapSizes.begin(), kMapSizes.end());
    if (kept.mapSize) sizes = {wanted.mapSize};
    std::vector<Configuration> all;
    for (const int wavelengths : spectra) {
        for (const int grid : kGrids) {
            for (const int size : sizes) {
                for (const int steps : {kFewSteps, kManySteps}) all.push_back(expected({grid, size, wavelengths, steps}, known));
            }
        }
    }
    return all;
}

}  // namespace caustream::render
