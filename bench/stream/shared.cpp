#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "bench/statistics.h"
#include "bench/stream/scenarios.h"
#include "bench/stream/server_child.h"
#include "error.h"
#include "tests/e2e/raw_client.h"

namespace caustream::bench {
namespace {

using protocol::Json;

constexpr int kViewers = 5;
constexpr double kNoise = 1.0;
// docs/pipeline.md: what depends on the light and not on the camera.
constexpr std::array kLightSide = {"caster_layers", "photon_list", "receiver_depth", "shadow",   "photon_trace",
                                   "photon_paths",  "map_resolve", "spectral_step",  "gap_fill", "outer_map"};

bool lightSide(const std::string& pass) { return std::ranges::find(kLightSide, pass) != kLightSide.end(); }

struct Cost {
    int lightPasses = 0;
    double lightMs = 0, renderMs = 0;
};

Cost costOf(const Json& stats) {
    Cost cost{.renderMs = stats.at("render_ms")};
    for (const Json& pass : stats.at("plan")) cost.lightPasses += pass.at("run").get<bool>() && lightSide(pass.at("pass"));
    for (const Json& stage : stats.at("stages")) {
        if (lightSide(stage.at("pass"))) cost.lightMs += stage.at("ms").get<double>();
    }
    return cost;
}

}  // namespace

Report shared(const ScenarioOptions& options) {
    const ServerChild server(options.server, {"--gpu", options.gpu});
    Report report("shared");
    const Json picture = {{"width", 512}, {"height", 512}};
    e2e::RawClient owner(server.port());
    const Json welcome = owner.hello();
    owner.update({{"scene", {"builtin", "sphere"}},
                  {"transport", {{"mode", "refined"}, {"photon_grid", 180}, {"wavelengths", 7}, {"map_size", 512}}},
                  {"stream", picture}});
    const bool follow = std::ranges::find(welcome.at("caps"), "follow") != welcome.at("caps").end();
    std::vector<std::unique_ptr<e2e::RawClient>> viewers;
    for (int i = 1; i < kViewers; ++i) {
        viewers.push_back(std::make_unique<e2e::RawClient>(server.port()));
        viewers.back()->hello(follow ? Json{{"role", "view"}, {"follow", welcome.at("session")}} : Json::object());
        if (!follow) viewers.back()->update({{"scene", {"builtin", "sphere"}}, {"transport", {{"mode", "refined"}, {"photon_grid", 180}, {"wavelengths", 7}}}});
        viewers.back()->update({{"stream", picture}, {"camera", {{"eye", {2.0 + 0.2 * i, 1.5, 2.0}}}}});
    }

    // After each change of the light everyone asks for a frame; the statistics before it say which passes ran.
    std::vector<double> passesOnce, passesAll, fifthMs, cameraSideMs, lightMs;
    const int warmUp = std::max(2, options.frames / 6);
    for (int i = 0; i < options.frames + warmUp; ++i) {
        const Json light = {{"lights", {{"key", {{"position", {0.35 + 1e-3 * i, 1.9, 0.3}}}}}}};
        owner.update(light);
        if (!follow) {
            for (const auto& viewer : viewers) viewer->update(light);
        }
        owner.requestFrame();
        const Cost first = costOf(owner.stats.back());
        int all = first.lightPasses;
        double last = 0;
        for (const auto& viewer : viewers) {
            viewer->requestFrame();
            const Cost cost = costOf(viewer->stats.back());
            all += cost.lightPasses;
            last = cost.renderMs;
        }
        if (i < warmUp) continue;
        passesOnce.push_back(first.lightPasses);
        passesAll.push_back(all);
        fifthMs.push_back(last);
        lightMs.push_back(first.lightMs);
        cameraSideMs.push_back(first.renderMs - first.lightMs);
    }
    report.note(std::string("scene sphere, 512 x 512, five viewers") + (follow ? " (one and four that follow it), " : " of the same light, ") +
                std::to_string(options.frames) + " moves of the light");
    report.shown("light-side passes for one viewer, per move", median(passesOnce), "");
    report.atMost("light-side passes for five viewers, per move, in those for one",
                  quantile(passesAll, 1.0) / std::max(1.0, quantile(passesOnce, 1.0)), 1.0, "");
    report.shown("light-side passes, time", median(lightMs), "ms");
    report.shown("camera-side passes of the first viewer", median(cameraSideMs), "ms");
    report.atMost("frame of the fifth viewer, in the first one's camera-side passes", median(fifthMs) / median(cameraSideMs), kNoise, "");
    return report;
}

}  // namespace caustream::bench
