// caustream-bench peers: the same caustic from POV-Ray's photon maps and from traced transport, time to equal error.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "bench/accuracy/clock.h"
#include "bench/accuracy/subject.h"
#include "bench/accuracy/tables.h"
#include "bench/accuracy/truth.h"
#include "bench/accuracy_options.h"
#include "bench/commands.h"
#include "bench/peers/povray.h"
#include "bench/peers/povray_scene.h"
#include "error.h"

namespace caustream::bench {

namespace {

using peers::PovrayImage;
using peers::PovrayPhotons;

struct PeersOptions {
    std::string scene = "gem", gpu = "software", markdown;
    std::vector<std::int64_t> counts = {100'000, 400'000, 1'600'000, 6'400'000};
    std::vector<int> grids = {128, 256, 512, 1024, 2048};
    int wavelength = 580, map = 1024, threads = 2;
    bool allWavelengths = false;
};

// One way to spend time on the picture, and what came of it.
struct Point {
    std::string what;
    std::uint64_t photons = 0;
    Spent spent;
    double error = 0, flux = 0;      // relative L1 and flux ratio, means of the wavelengths
};

void addError(Point& point, const float* map, const reference::Reference& reference, std::size_t band, std::size_t bands) {
    const int cells = reference.window.cells;
    const std::size_t area = static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells);
    const tracer::Difference d = tracer::difference(map, &reference.mono7.values[band * area], cells, cells);
    point.error += d.relativeL1 / static_cast<double>(bands), point.flux += d.fluxRatio / static_cast<double>(bands);
}

// POV-Ray knows no wavelengths: each is a run of its own, with its index and absorption.
std::vector<Point> povrayPoints(const PeersOptions& options, const reference::Reference& reference, const scene::Bounds& caster, const std::vector<std::size_t>& bands) {
    const int cells = reference.window.cells;
    const PovrayImage direct = peers::runPovray(peers::povrayDirectScene(reference, caster), cells, options.threads);
    double shown = 0.0, irradiance = 0.0;
    for (std::size_t i = 0; i < direct.green.size(); ++i) shown += direct.green[i], irradiance += reference.direct.values[i];
    const double unit = irradiance / shown;   // of the picture, from the direct light's closed form

    std::vector<Point> points;
    for (const std::int64_t count : options.counts) {
        // Few photons are better off with few to an estimate: of each count the better stays.
        std::optional<Point> best;
        for (const PovrayPhotons& photons : {PovrayPhotons{count, 5, 20}, PovrayPhotons{count, 10, 30}, PovrayPhotons{count, 20, 100}}) {
            Point point{.what = format("%.1f million asked for, gather %d to %d", 1e-6 * static_cast<double>(count), photons.gatherLeast, photons.gatherMost), .spent = {}};
            for (const std::size_t band : bands) {
                const PovrayImage image = peers::runPovray(povrayScene(reference, caster, reference.nm[band], photons), cells, options.threads);
                if (image.clipped) throw Error("POV-Ray's picture is too bright for its scale");
                std::vector<float> map;
                for (std::size_t i = 0; i < image.green.size(); ++i) map.push_back(static_cast<float>(unit * (image.green[i] - direct.green[i])));
                addError(point, map.data(), reference, band, bands.size());
                point.photons += image.shot;
                point.spent += {image.seconds, image.cpuSeconds};
            }
            std::fprintf(stderr, "POV-Ray, %s: %.2f CPU s, %.4f\n", point.what.c_str(), point.spent.cpuSeconds, point.error);
            if (!best || point.error < best->error) best = point;
        }
        points.push_back(*best);
    }
    return points;
}

// A frame with so many photons, of a light pose never seen before: light views, trace, map and its read-back. Each wavelength
// is a run of its own, as it is there.
std::vector<Point> tracedPoints(const PeersOptions& options, const Subject& subject, const reference::Reference& reference, const std::vector<std::size_t>& bands) {
    Renderer renderer(options.gpu);
    const auto cells = subject.plane->weights().size();
    std::vector<Point> points;
    for (const int grid : options.grids) {
        Point point{.what = format("grid %d", grid), .spent = {}};
        Configuration configuration;
        configuration.transport.mode = render::Mode::Traced;
        configuration.transport.mapSize = options.map;
        configuration.transport.photonGrid = grid;
        configuration.transport.bounces = 15;    // what the reference follows
        render::Pipeline& pipeline = renderer.pipeline(configuration, subject.fingerprint);
        for (const std::size_t band : bands) {
            configuration.transport.wavelengthsNm = {reference.nm[band]};
            render::Request request = mapRequest(subject.scene, configuration);
            request.scene = std::make_shared<const scene::Scene>(withMovedLight(subject.scene, 1));
            for (int i = 0; i < 2 && band == bands.front(); ++i) pipeline.run(request), request.scene = std::make_shared<const scene::Scene>(withMovedLight(subject.scene, 2));   // makes the images
            request.scene = std::make_shared<const scene::Scene>(subject.scene);
            const Clock clock;
            const render::Frame map = pipeline.run(request);
            point.spent += clock.spent();
            point.photons += map.stats.photons;
            addError(point, &mapOnWindow(pipeline, request, map, *subject.plane, 8)[cells], reference, band, bands.size());   // of three alike channels, green
        }
        points.push_back(point);
        std::fprintf(stderr, "traced, %s: %.2f CPU s, %.4f\n", point.what.c_str(), point.spent.cpuSeconds, point.error);
    }
    return points;
}

// CPU seconds for an error, between points on straight lines of logarithms; of the first point where that is better
// already, nothing where none is as good.
std::optional<double> secondsFor(double error, const std::vector<Point>& points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (points[i].error > error) continue;
        if (i == 0) return points[0].spent.cpuSeconds;
        const Point &a = points[i - 1], &b = points[i];
        const double t = std::log(error / a.error) / std::log(b.error / a.error);
        return std::exp(std::lerp(std::log(a.spent.cpuSeconds), std::log(b.spent.cpuSeconds), t));
    }
    return std::nullopt;
}

std::string pointTable(const std::vector<Point>& povray, const std::vector<Point>& traced) {
    std::vector<std::vector<std::string>> rows = {{"", "photons shot", "CPU s", "wall s", "relative L1", "flux ratio", "traced, CPU s for that error", "ratio"}};
    const auto add = [&](const char* who, const Point& point, bool compare) {
        rows.push_back({std::string(who) + point.what, format("%llu", static_cast<unsigned long long>(point.photons)), format("%.2f", point.spent.cpuSeconds),
                        format("%.2f", point.spent.seconds), format("%.4f", point.error), format("%.3f", point.flux), "", ""});
        if (!compare) return;
        const std::optional<double> ours = secondsFor(point.error, traced);
        if (!ours) return;
        const bool first = point.error >= traced.front().error;
        rows.back()[6] = format("%s%.3f", first ? "<= " : "", *ours), rows.back()[7] = format("%s%.1f", first ? ">= " : "", point.spent.cpuSeconds / *ours);
    };
    for (const Point& point : povray) add("POV-Ray, ", point, true);
    for (const Point& point : traced) add("traced, ", point, false);
    return table(rows);
}

void comparePeers(const PeersOptions& options) {
    const reference::Reference reference = reference::load(options.scene);
    const Subject subject = loadSubject("reference:" + options.scene);
    const bool povray = peers::havePovray();
    if (!povray) std::printf("POV-Ray is not there, so only this program is measured. On Debian and Ubuntu: apt-get install povray\n");

    std::vector<std::size_t> bands;
    for (std::size_t i = 0; i < reference.nm.size(); ++i) {
        if (options.allWavelengths || reference.nm[i] == options.wavelength) bands.push_back(i);
    }
    if (bands.empty()) throw Error("the reference has no map at " + std::to_string(options.wavelength) + " nm, only at 380, 430 ... 680");
    const std::vector<Point> traced = tracedPoints(options, subject, reference, bands);
    const std::vector<Point> theirs = povray ? povrayPoints(options, reference, subject.scene.geometry->casterBounds, bands) : std::vector<Point>{};
    const std::string wavelengths = options.allWavelengths ? "7 wavelengths" : std::to_string(options.wavelength) + " nm";
    const std::string text = format("The %s's floor at %s, %d x %d cells, map %d:\n\n", options.scene.c_str(), wavelengths.c_str(), reference.window.cells,
                                    reference.window.cells, options.map) +
                             pointTable(theirs, traced);
    std::printf("%s", text.c_str());
    if (!options.markdown.empty()) writeFile(options.markdown, text);
}

}  // namespace

void addPeers(CLI::App& app) {
    const auto options = std::make_shared<PeersOptions>();
    CLI::App* command = app.add_subcommand("peers", "time to equal error on a reference scene: POV-Ray's photon maps and traced transport");
    command->add_option("--scene", options->scene, "gem, prism or sphere")->check(CLI::IsMember({"gem", "prism", "sphere"}))->capture_default_str();
    command->add_option("--gpu", options->gpu, "auto, software, an index or part of a name")->capture_default_str();
    command->add_option("--counts", options->counts, "photons that POV-Ray is asked for")->capture_default_str();
    command->add_option("--nm", options->wavelength, "380, 430 ... 680")->capture_default_str();
    command->add_flag("--all-wavelengths", options->allWavelengths, "all seven: POV-Ray needs a run for each");
    command->add_option("--map", options->map, "texels a side")->check(CLI::Range(64, 2048))->capture_default_str();
    command->add_option("--grids", options->grids, "photons a side, of traced transport")->check(CLI::Range(16, 4096))->capture_default_str();
    command->add_option("--threads", options->threads, "of POV-Ray")->check(CLI::Range(1, 64))->capture_default_str();
    command->add_option("--markdown", options->markdown, "a file for the table");
    command->footer("CPU seconds are user and system time of all threads: of POV-Ray the whole process, of this program the frames, each with the\n"
                    "light's views, the trace, the map and its read-back. The reference's own error is .006. POV-Ray (Debian: apt-get install povray)\n"
                    "gets the caster as it is, its best jitter, the best of three gather settings for each count, and no charge for the direct\n"
                    "light, which is taken off its picture.");
    command->callback([options] { comparePeers(*options); });
}

}  // namespace caustream::bench
