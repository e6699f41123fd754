#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/commands.h"
#include "bench/stream/scenarios.h"
#include "bench/stream/server_child.h"
#include "error.h"

namespace caustream::bench {
namespace {

struct StreamOptions {
    ScenarioOptions scenario;
    std::vector<std::string> names;
    std::string url = connection::kDefaultUrl, scene = "sphere", json, markdown;
};

const std::map<std::string, Report (*)(const ScenarioOptions&)> kScenarios = {
    {"steady", steady}, {"ladder", ladder}, {"neighbours", neighbours}, {"latency", latency},
    {"shared", shared}, {"soak", soak},     {"malformed", malformed}};

void run(StreamOptions options) {
    if (options.scenario.server.empty()) options.scenario.server = serverBesideUs();
    const auto address = connection::parseAddress(options.url);
    if (!address) throw Error(address.error());
    bool held = true;
    std::string json, markdown = "| scenario | figure | measured | limit | held |\n| --- | --- | --- | --- | --- |\n";
    for (const std::string& name : options.names) {
        const Report report = name == "added" ? added(*address, options.scene, options.scenario.frames) : kScenarios.at(name)(options.scenario);
        report.print();
        held = held && report.held();
        json += report.json();
        markdown += report.markdown();
    }
    if (!options.json.empty()) std::ofstream(options.json, std::ios::app) << json;
    if (!options.markdown.empty()) std::ofstream(options.markdown) << markdown;
    if (!held) throw CLI::RuntimeError(1);
}

}  // namespace

void addStream(CLI::App& app) {
    const auto options = std::make_shared<StreamOptions>();
    CLI::App* command = app.add_subcommand("stream", "how frames reach their viewers: slow links, bad neighbours, hostile input, long runs");
    std::vector<std::string> names = {"added"};
    for (const auto& [name, scenario] : kScenarios) names.push_back(name);
    command->add_option("scenario", options->names, "steady, ladder, neighbours, latency, shared, soak, malformed: each starts a server of its own. "
                                                    "added: what the socket adds, with a server that runs (--url)")
        ->required()
        ->check(CLI::IsMember(names));
    command->add_option("--server", options->scenario.server, "the server's program; default: caustream-server beside this one");
    command->add_option("--gpu", options->scenario.gpu, "as caustream-server's")->capture_default_str();
    command->add_option("--minutes", options->scenario.minutes, "how long steady, neighbours and soak go on; default: half a minute, soak three")
        ->check(CLI::Range(0.05, 240.0));
    command->add_option("--frames", options->scenario.frames, "frames counted by latency, shared and added")->check(CLI::Range(3, 10'000))->capture_default_str();
    command->add_option("--count", options->scenario.count, "messages and files that malformed sends")->check(CLI::Range(1, 1'000'000))->capture_default_str();
    command->add_option("--corpus", options->scenario.corpus, "a folder whose files malformed sends, too")->check(CLI::ExistingDirectory);
    command->add_option("--svg", options->scenario.svg, "where ladder draws age and level against time");
    command->add_option("--json", options->json, "appends a JSON line per figure to this file");
    command->add_option("--markdown", options->markdown, "writes the figures as a table to this file");
    command->add_option("--url", options->url, "the server that added measures")->capture_default_str();
    command->add_option("--scene", options->scene, "the built-in scene that added shows")->capture_default_str();
    command->callback([options] { run(*options); });
}

}  // namespace caustream::bench
