// caustream-bench converge: what a viewer at rest gets, and whether it is right.
#include <cstdio>
#include <memory>

#include "bench/accuracy/tables.h"
#include "bench/accuracy_options.h"
#include "bench/commands.h"
#include "bench/converge/first_frames.h"
#include "bench/converge/reference_scenes.h"
#include "bench/converge/scene_report.h"
#include "bench/statistics.h"
#include "scene/builtin_scenes.h"

namespace caustream::bench {

namespace {

struct ConvergeOptions {
    std::vector<std::string> scenes = {"gem"};
    std::string gpu = "auto", markdown;
    int turns = 15;
    bool all = false, quick = false, references = false;
    ReportSettings report;
};

std::string duration(double seconds) { return seconds > 0.0 ? format("%.2f", seconds) : "never"; }

std::string sceneTable(const std::vector<SceneReport>& reports, const ReportSettings& settings) {
    std::vector<std::vector<std::string>> rows = {{"scene", format("s to %.0f%%", 100.0 * settings.good), "s in all", "frames", "frames/s", "photons", "estimate",
                                                   "error", "against the tracer", "its noise", "flux", "cut", "ledger gap"}};
    for (const SceneReport& r : reports) {
        rows.push_back({r.scene, duration(r.secondsToGood), format("%.2f%s", r.secondsToEnd, r.converged ? "" : " (not there)"), std::to_string(r.frames),
                        format("%.1f", r.framesPerSecond), format("%llu", static_cast<unsigned long long>(r.photons)), format("%.4f", r.estimateAtEnd),
                        format("%.4f", r.errorAtEnd), format("%.4f", r.truth), format("%.4f", r.truthNoise), format("%.4f", r.flux), format("%.4f", r.cut),
                        format("%.1e", r.ledgerGap)});
    }
    return table(rows);
}

std::string firstFrameTable(const std::string& scene, const std::vector<FirstFrame>& frames) {
    std::vector<std::vector<std::string>> rows = {{"first frame after a light move, " + scene, "ms", "+-", "CPU ms", "photons", "over refined"}};
    for (const FirstFrame& f : frames) {
        rows.push_back({f.mode, format("%.1f", f.ms), format("%.1f", f.spreadMs), format("%.1f", f.cpuMs), std::to_string(f.photons), format("%.2f", f.ratio)});
    }
    return table(rows);
}

// Milliseconds of a frame at rest, pass by pass.
std::string stageLines(const std::vector<SceneReport>& reports) {
    std::string text = "Milliseconds of the passes of a frame at rest, medians:\n\n";
    for (const SceneReport& r : reports) {
        text += "- " + r.scene + ":";
        for (const render::StageTime& stage : r.stages) text += format(" %s %.1f", stage.pass.c_str(), stage.ms);
        text += "\n";
    }
    return text;
}

std::string claims(const std::vector<SceneReport>& reports) {
    std::string text;
    for (const SceneReport& r : reports) {
        if (r.scene == "gem") {
            text += claim(r.fast(), format("gem: 2%% after %s s (3 s) at %.1f frames a second (10)", duration(r.secondsToGood).c_str(), r.framesPerSecond));
        }
        text += claim(r.truth <= 0.02, format("%s: %.4f against the tracer (.02), whose own noise is %.4f", r.scene.c_str(), r.truth, r.truthNoise));
        text += claim(r.ledgerGap <= 1e-4, format("%s: the ledger closes to %.1e (1e-4)", r.scene.c_str(), r.ledgerGap));
    }
    return text;
}

void converge(ConvergeOptions options) {
    Renderer renderer(options.gpu);
    if (options.all) {
        options.scenes.clear();
        for (const scene::BuiltinScene& scene : scene::builtinScenes()) options.scenes.emplace_back(scene.name);
    }
    if (options.quick) options.report.tracerPhotons = 1u << 19, options.turns = 5;
    std::printf("%s; pictures %d x %d, map %d, %d bounces; calibration: fixed loop %.1f ms\n\n", renderer.context().renderer().c_str(), options.report.pictureSize,
                options.report.pictureSize, options.report.map, options.report.bounces, calibrationMs());
    std::string text;
    const auto say = [&](const std::string& part) {
        std::printf("%s\n", part.c_str());
        std::fflush(stdout);
        text += part + "\n";
    };
    // Times first: the machine is as it is found
    const Subject gem = loadSubject("gem");
    say(firstFrameTable("gem", firstFrames(renderer, gem, options.report.pictureSize, options.turns)));
    const PhotonTime photons = photonTime(renderer, gem, options.turns);
    say(format("The gem's planes: %u photons x 7 wavelengths x 8 bounces in %.1f ms.\n", photons.photons, photons.ms) +
        claim(photons.msOfTenThousand() <= 35.0, format("%.1f ms for 10,000 photons (35)", photons.msOfTenThousand())));
    renderer.forget();

    std::vector<SceneReport> reports;
    for (const std::string& scene : options.scenes) reports.push_back(reportScene(renderer, scene, options.report));
    say(sceneTable(reports, options.report));
    say(stageLines(reports));
    std::string claimed = claims(reports);
    if (options.references) {
        const std::vector<ReferenceRow> rows = compareReferences(renderer);
        say(referenceTable(rows));
        claimed += referenceClaims(rows);
    }
    say(claimed);
    if (!options.markdown.empty()) writeFile(options.markdown, text);
}

}  // namespace

void addConverge(CLI::App& app) {
    const auto options = std::make_shared<ConvergeOptions>();
    ReportSettings& report = options->report;
    report.cacheFolder = defaultCacheFolder();
    CLI::App* command = app.add_subcommand("converge", "a viewer at rest: how soon traced transport's map is good, and what it is next to the truth");
    command->add_option("--scene", options->scenes, subjectHelp())->capture_default_str();
    command->add_flag("--all", options->all, "every built-in scene");
    command->add_flag("--references", options->references, "the scenes of tests/reference, too, wavelength by wavelength");
    command->add_option("--gpu", options->gpu, "auto, software, an index or part of a name")->capture_default_str();
    command->add_option("--size", report.pictureSize, "pixels a side")->check(CLI::Range(64, 2048))->capture_default_str();
    command->add_option("--cells", report.cells, "cells a side that maps are compared on")->check(CLI::Range(16, 1024))->capture_default_str();
    command->add_option("--map", report.map, "texels a side")->check(CLI::Range(64, 2048))->capture_default_str();
    command->add_option("--bounces", report.bounces, "reflections inside")->check(CLI::Range(0, 32))->capture_default_str();
    command->add_flag("--exact-receivers", report.exactReceivers, "receivers triangle by triangle, not through the map's view");
    command->add_option("--turns", options->turns, "first frames counted")->check(CLI::Range(3, 1000))->capture_default_str();
    command->add_option("--seconds", report.mostSeconds, "most that a scene has to converge in")->check(CLI::Range(1.0, 3600.0))->capture_default_str();
    command->add_option("--photons", report.tracerPhotons, "of the reference tracer")->check(CLI::Range(1024, 1 << 30))->capture_default_str();
    command->add_option("--cache", report.cacheFolder, "where references are kept")->capture_default_str();
    command->add_option("--markdown", options->markdown, "file for the tables of docs/accuracy.md");
    command->add_flag("--quick", options->quick, "fewer turns and photons: to try");
    command->footer("Seconds are wall clock over whole frames, a moving one and then frames at rest. \"error\" is relative L1 of luminance against the same\n"
                    "transport with eight times the photons, on cells x cells; \"against the tracer\" is against bench/reference, on cells of 4 x 4 texels of the map.");
    command->callback([options] { converge(*options); });
}

}  // namespace caustream::bench
