#include "bench/converge/scene_report.h"

#include <cstdio>

#include "bench/accuracy/tables.h"
#include "bench/accuracy/truth.h"
#include "bench/progress.h"

namespace caustream::bench {

namespace {

constexpr int kTexelsOfCell = 4;

// Sums of k x k cells.
std::vector<float> joined(const std::vector<float>& cells, int side, int k) {
    const int few = side / k;
    std::vector<float> sums(static_cast<std::size_t>(few * few));
    for (int j = 0; j < few * k; ++j) {
        for (int i = 0; i < few * k; ++i) sums[static_cast<std::size_t>(j / k * few + i / k)] += cells[static_cast<std::size_t>(j * side + i)];
    }
    return sums;
}

// Where the light went, in shares of what reached casters: of two tracers that agree, all but the noise is the same. Landed
// is all that met a receiver: of the reference also where no map shows it, of the map's tracer also what left its views.
void sayLedgers(const std::string& scene, const render::EnergyLedger& own, const tracer::Result& reference) {
    const tracer::Ledger& theirs = reference.continuous;
    const auto share = [](double part, double whole) { return whole > 0.0 ? part / whole : 0.0; };
    std::fprintf(stderr, "%s: on casters %.5e (tracer %.5e); of it deposited %.4f, left the map %.4f, no receiver %.4f, absorbed %.4f, reflected first %.4f, "
                 "rejected %.4f, cut %.4f\n", scene.c_str(), own.onCasters, theirs.onCasters, share(own.deposited, own.onCasters), share(own.leftMap, own.onCasters),
                 share(own.noReceiver, own.onCasters), share(own.absorbed, own.onCasters), share(own.reflected, own.onCasters), share(own.rejected, own.onCasters),
                 share(own.cut, own.onCasters));
    std::fprintf(stderr, "%s: the tracer: landed %.4f (hidden %.4f), escaped %.4f, absorbed %.4f (by mirrors %.4f), reflected first %.4f, below threshold %.4f, "
                 "too many interfaces %.4f\n", scene.c_str(), share(theirs.landed, theirs.onCasters), reference.hidden.empty() ? 0.0 : share(reference.hidden.front(), theirs.onCasters),
                 share(theirs.escaped, theirs.onCasters), share(theirs.absorbed + theirs.mirrors, theirs.onCasters), share(theirs.mirrors, theirs.onCasters),
                 share(theirs.firstReflected, theirs.onCasters), share(theirs.belowThreshold, theirs.onCasters), share(theirs.interfaceLimit, theirs.onCasters));
}

}  // namespace

SceneReport reportScene(Renderer& renderer, const std::string& scene, const ReportSettings& settings) {
    const Subject subject = loadSubject(scene);
    Configuration configuration;
    configuration.transport.mode = render::Mode::Traced;
    configuration.transport.mapSize = settings.map;
    configuration.transport.bounces = settings.bounces;
    configuration.transport.exactReceivers = settings.exactReceivers;
    std::fprintf(stderr, "%s: at rest\n", scene.c_str());
    const AtRest rest = comeToRest(renderer, subject, configuration, {.pictureSize = settings.pictureSize, .cells = settings.cells, .mostSeconds = settings.mostSeconds});
    const RestPoint& end = rest.points.back();
    SceneReport report{.scene = scene, .where = rest.window.ofPlane() ? "the floor" : "the light's view"};
    report.frames = end.frames, report.photons = end.photons, report.converged = rest.converged;
    report.secondsToEnd = end.spent.seconds, report.estimateAtEnd = end.estimate;
    report.framesPerSecond = end.frames / end.spent.seconds;
    report.stages = rest.stages;
    report.ledgerGap = rest.worstLedgerGap;
    report.cut = rest.ledger.onCasters > 0.0 ? rest.ledger.cut / rest.ledger.onCasters : 0.0;

    // The same transport with more photons
    std::fprintf(stderr, "%s: its own reference\n", scene.c_str());
    Configuration longer = configuration;
    longer.transport.targetError = 1e-4;
    renderer.forget();
    const AtRest reference = comeToRest(renderer, subject, longer, {.cells = settings.cells, .mostSeconds = 3.0 * settings.mostSeconds, .pictures = false,
                                        .mostPhotons = static_cast<std::uint64_t>(settings.referencePhotons * static_cast<double>(end.photons))});
    const float* own = reference.points.back().luminance.data();
    report.errorAtEnd = relativeL1(end.luminance, own);
    for (auto point = rest.points.rbegin(); point != rest.points.rend(); ++point) {
        const double error = relativeL1(point->luminance, own);
        if (error > settings.good) break;
        report.secondsToGood = point->spent.seconds, report.errorThere = error;
    }

    // The reference tracer
    Progress progress("reference of " + scene);
    const tracer::Result traced = traceSpectrum(subject, rest.window, settings.tracerPhotons, settings.cacheFolder, [&](double share) { progress.at(share); });
    const tracer::Image image = weighed(rest.window.ofPlane() ? traced.windows.front().xyz : traced.maps.front().xyz, rest.window);
    const std::size_t area = rest.window.weights().size();
    const std::vector<float> truth(image.values.begin() + static_cast<std::ptrdiff_t>(area), image.values.begin() + static_cast<std::ptrdiff_t>(2 * area));
    // Cells of enough texels: of a plane they are about as wide as its own.
    const int k = std::max(1, kTexelsOfCell * settings.cells / settings.map), side = settings.cells / k;
    const std::vector<float> coarse = joined(end.luminance, settings.cells, k), known = joined(truth, settings.cells, k);
    const tracer::Difference d = tracer::difference(coarse.data(), known.data(), side, side);
    report.truth = d.relativeL1, report.flux = d.fluxRatio;
    report.truthNoise = image.relativeL1[1] / k;   // of independent cells
    renderer.forget();
    sayLedgers(scene, rest.ledger, traced);
    std::fprintf(stderr, "%s: %.4f against the tracer, whose noise is %.4f; error %.4f, estimated %.4f after %.1f s\n", scene.c_str(), report.truth, report.truthNoise,
                 report.errorAtEnd, report.estimateAtEnd, report.secondsToEnd);
    return report;
}

}  // namespace caustream::bench
