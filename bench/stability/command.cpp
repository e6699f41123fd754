#include <algorithm>
#include <cstdio>
#include <memory>

#include "bench/commands.h"
#include "bench/progress.h"
#include "bench/stability/picture.h"
#include "bench/stability/report.h"
#include "error.h"

namespace caustream::bench {

namespace {

using namespace stability;

struct StabilityOptions {
    std::string gpu = "software", mode, only, group, markdown, json, pictures;
    int random = 80, frames = 48;
    bool list = false;
};

// The cases asked for: all, one by its name, or one by a seed that may never have been drawn before.
std::vector<Case> chosenCases(const StabilityOptions& options) {
    std::vector<Case> cases = allCases(options.random);
    if (!options.group.empty()) {
        std::erase_if(cases, [&](const Case& one) { return one.group != options.group; });
        if (cases.empty()) throw Error("no group \"" + options.group + "\"; the table's second column names them");
    }
    if (options.only.empty()) return cases;
    for (Case& one : cases) {
        if (one.name == options.only) return {std::move(one)};
    }
    const std::string digits = options.only.starts_with("seed-") ? options.only.substr(5) : options.only;
    if (!digits.empty() && digits.size() < 19 && std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; })) {
        return {randomCase(std::stoull(digits))};
    }
    throw Error("no case \"" + options.only + "\"; --list names them, and any number is the seed of one");
}

std::vector<Mode> chosenModes(const StabilityOptions& options) {
    std::vector<Mode> chosen;
    std::string names;
    for (const Mode& mode : modes()) {
        names += (names.empty() ? "" : ", ") + mode.name;
        if (options.mode.empty() || options.mode == mode.name) chosen.push_back(mode);
    }
    if (chosen.empty()) throw Error("no mode \"" + options.mode + "\"; there are " + names);
    return chosen;
}

struct FileCloser {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, FileCloser>;

File create(const std::string& path) {
    File file(std::fopen(path.c_str(), "w"));
    if (!file) throw Error("cannot write " + path + "; is its folder there?");
    return file;
}

void run(const StabilityOptions& options) {
    const std::vector<Case> cases = chosenCases(options);
    if (options.list) {
        for (const Case& one : cases) std::printf("%s\n", one.name.c_str());
        return;
    }
    const File json = options.json.empty() ? nullptr : create(options.json);
    const std::vector<Mode> chosen = chosenModes(options);
    Renderer renderer(options.gpu);
    std::vector<Result> results;
    {
        Progress progress("stability");
        for (const Mode& mode : chosen) {
            for (const Case& one : cases) {
                progress.at(static_cast<double>(results.size()) / static_cast<double>(cases.size() * chosen.size()), mode.name + " " + one.name);
                results.push_back({one.group, one.name, mode.name, mode.mustPass, examine(renderer, one, mode, options.frames)});
                if (!options.pictures.empty()) writePicture(renderer, one, mode, options.pictures + "/" + one.name + "-" + mode.name + ".ppm");
                if (json) std::fprintf(json.get(), "%s\n", jsonLine(results.back()).c_str()), std::fflush(json.get());
            }
        }
    }
    std::printf("%s, %zu cases\n%s", renderer.context->renderer().c_str(), cases.size(), textReport(results).c_str());
    if (!options.markdown.empty()) std::fputs(markdownReport(results).c_str(), create(options.markdown).get());
    if (failuresThatCount(results) > 0) throw CLI::RuntimeError(1);
}

}  // namespace

void addStability(CLI::App& app) {
    const auto options = std::make_shared<StabilityOptions>();
    CLI::App* command = app.add_subcommand("stability", "stiff, extreme and random scenes: finite, closed, repeatable, steady; exit status 1 if one is not");
    command->add_option("--case", options->only, "one alone, by its name or by any seed");
    command->add_option("--group", options->group, "one group alone: glass, light, caster, nested, aimed, bounces, mirror, receiver, ...");
    command->add_option("--mode", options->mode, "one alone");
    command->add_option("--random", options->random, "random scenes, seeds 1 to this")->check(CLI::Range(0, 1'000'000))->capture_default_str();
    command->add_option("--frames", options->frames, "frames of a light that goes round and comes back")->check(CLI::Range(2, 1'000'000))->capture_default_str();
    command->add_option("--markdown", options->markdown, "file for the table of docs/accuracy.md");
    command->add_option("--json", options->json, "file for a line of JSON per case");
    command->add_option("--pictures", options->pictures, "folder for a picture (PPM) of each");
    command->add_option("--gpu", options->gpu, "auto, software, an index or part of a name")->capture_default_str();
    command->add_flag("--list", options->list, "name the cases");
    command->callback([options] { run(*options); });
}

}  // namespace caustream::bench
