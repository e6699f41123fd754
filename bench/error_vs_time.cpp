#include <cstdio>

#include "bench/accuracy/plot.h"
#include "bench/accuracy/tables.h"
#include "bench/accuracy_options.h"
#include "bench/commands.h"
#include "bench/statistics.h"
#include "bench/vs_thesis.h"
#include "error.h"

namespace caustream::bench {

namespace {

struct Options : AccuracyOptions {
    std::vector<std::string> scenes = {"reference:sphere", "reference:prism", "reference:gem"};
    std::vector<std::string> configurations;
    bool only = false, vsThesis = false;
};

std::vector<Configuration> configurationsOf(const Options& options) {
    std::vector<Configuration> list;
    if (!options.only) list = defaultConfigurations(options.quick);
    for (const std::string& text : options.configurations) {
        const auto parsed = parseConfiguration(text);
        if (!parsed) throw Error(parsed.error());
        list.push_back(*parsed);
    }
    if (list.empty()) throw Error("--only leaves no configuration; give some with --config");
    return list;
}

std::string fileName(std::string scene) {
    scene = scene.substr(scene.find_last_of('/') + 1);
    for (char& c : scene) c = c == ':' || c == ' ' ? '-' : c;
    return scene;
}

Results measure(Study& study, const std::string& scene, const std::vector<Configuration>& configurations) {
    const Subject subject = loadSubject(scene);
    const Truth truth = study.truth(subject);
    Results results{.scene = scene, .luminanceNoise = truth.luminanceNoise(), .bandsNoise = truth.bandsNoise()};
    results.where = format("%d x %d cells of %s", truth.window.cells(), truth.window.cells(), truth.window.ofPlane() ? "the floor" : "the light's view");
    std::printf("\n%s, compared on %s; the reference's own error %.4f of luminance, %.4f per wavelength (%.0f s%s)\n", scene.c_str(),
                results.where.c_str(), results.luminanceNoise, results.bandsNoise, truth.seconds, truth.cached ? ", from the cache" : "");
    std::vector<Job> jobs;
    for (const Configuration& configuration : configurations) jobs.push_back({&subject, &truth, configuration});
    results.outcomes = study.run(scene, jobs);
    std::printf("%s", outcomeTable(results, false).c_str());
    std::fflush(stdout);
    return results;
}

// What the project promises of the reference scenes, photon grid and map 1024: each with its figure.
std::string claims(const Results& results) {
    struct Promise {
        std::string scene, configuration;
        double MapError::* figure;
        const char* what;
        double most;
    };
    static const std::vector<Promise> promises = {
        {"reference:sphere", "refined 7 grid 1024 map 1024", &MapError::bands, "relative L1, mean of seven wavelengths", 0.045},
        {"reference:prism", "refined 7 grid 1024 map 1024", &MapError::bands, "relative L1, mean of seven wavelengths", 0.015},
        {"reference:gem", "refined 7 grid 1024 map 1024", &MapError::bands, "relative L1, mean of seven wavelengths", 0.35},
        {"reference:prism", "refined continuous grid 1024 map 1024", &MapError::luminance, "relative L1 of the continuous spectrum's luminance", 0.02},
    };
    std::string text;
    for (const Promise& promise : promises) {
        if (promise.scene != results.scene) continue;
        for (const Outcome& outcome : results.outcomes) {
            const double figure = outcome.error.*promise.figure;
            if (outcome.configuration.name() != promise.configuration) continue;
            text += claim(figure <= promise.most, format("%s, %s: %s %.4f (%.3f claimed)", promise.scene.c_str(), promise.configuration.c_str(), promise.what,
                                                         figure, promise.most));
        }
    }
    return text;
}

std::string plotOf(const Results& results, const std::string& machine) {
    Plot plot{.title = results.scene + ": error against time", .noise = results.luminanceNoise};
    plot.subtitle = machine + "; on " + results.where + "; names: wavelengths at photon grid / map";
    for (const Outcome& outcome : results.outcomes) {
        plot.points.push_back({outcome.cost(), outcome.configuration.family(), outcome.configuration.label()});
    }
    return svg(plot);
}

void errorVsTime(Options options) {
    Renderer renderer(options.study.gpu);
    if (options.vsThesis) options.study.truth.photons /= 4;   // errors of tenths, on ten scenes
    begin(options, renderer);
    Journal journal(options.out + "/results.jsonl", options.fresh);
    Study study(renderer, journal, options.study);

    if (options.vsThesis) {
        writeFile(options.out + "/vs-thesis.md", vsThesis(study, {.quick = options.quick}));
        std::printf("\ncalibration: fixed loop %.1f ms\nwritten to %s: vs-thesis.md\n", calibrationMs(), options.out.c_str());
        return;
    }
    const std::vector<Configuration> configurations = configurationsOf(options);
    std::vector<Results> all;
    std::string markdown;
    for (const std::string& scene : options.scenes) {
        all.push_back(measure(study, scene, configurations));
        const std::string name = fileName(scene);
        writeFile(options.out + "/" + name + ".svg", plotOf(all.back(), renderer.context().renderer()));
        markdown += "![" + scene + ": error against time](images/accuracy/" + name + ".svg)\n\n" + outcomeTable(all.back(), true) + "\n";
    }
    std::printf("\n* on the Pareto front. calibration: fixed loop %.1f ms\n", calibrationMs());
    for (const Results& results : all) {
        std::printf("%s\n", bestLine(results).c_str());
        markdown += "- ";
        markdown += bestLine(results) + "\n";
    }
    std::string promised;
    for (const Results& results : all) promised += claims(results);
    std::printf("%s", promised.c_str());
    markdown += "\n";
    markdown += promised;
    writeFile(options.out + "/error-vs-time.csv", csv(all));
    writeFile(options.out + "/error-vs-time.json", json(all).dump(1));
    writeFile(options.out + "/error-vs-time.md", markdown);
    std::printf("written to %s: error-vs-time.csv, .json, .md and a plot for each scene\n", options.out.c_str());
}

}  // namespace

void addErrorVsTime(CLI::App& app) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("error-vs-time", "how wrong the spectral map is and how long its frame takes, for many configurations");
    command->add_option("--scene", options->scenes, subjectHelp())->capture_default_str();
    command->add_option("--config", options->configurations, "a further configuration: " + configurationHelp());
    command->add_flag("--only", options->only, "measure the given configurations alone");
    command->add_flag("--vs-thesis", options->vsThesis,
                      "instead: tables 3 and 4 of the thesis, for its algorithm and for this one, and the claims about both");
    addAccuracyOptions(*command, *options);
    command->footer("Times are whole frames after a move of the light. Errors are relative L1 = sum |a - b| / sum b against the exact reference.\n"
                    "Results are kept as they come: run the same command again to go on after it was stopped.\n"
                    "  caustream-bench error-vs-time --scene gem --only --config mode=thesis,wavelengths=21,grid=512,gap_fill=on --config grid=512");
    command->callback([options] { errorVsTime(*options); });
}

}  // namespace caustream::bench
