#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <thread>

#include "bench/progress.h"
#include "bench/statistics.h"
#include "bench/stream/relay.h"
#include "bench/stream/scenarios.h"
#include "bench/stream/server_child.h"
#include "bench/stream/timeline.h"
#include "bench/stream/watch.h"
#include "client/connection/connection.h"
#include "error.h"
#include "stream/ladder.h"

namespace caustream::bench {
namespace {

using connection::nowUs;

struct Phase {
    double bytesPerS, seconds;
    const char* name;
};
constexpr std::array<Phase, 4> kPhases = {{{20e6, 8, "20 MB/s"}, {2e6, 10, "2 MB/s"}, {0.6e6, 10, "0.6 MB/s"}, {4e6, 16, "4 MB/s"}}};
constexpr double kMostMs = 150, kAfterDownS = 2, kAfterUpS = 10;
constexpr std::uint64_t kWindowUs = 500'000;     // of a running median
constexpr std::uint64_t kStepUs = 50'000, kSearchUs = 5'000'000;

// Seconds from `fromUs` to the end of the last half second, of those that begin within kSearchUs, whose median age is not under the
// limit, or in which nothing came; 0: there was none.
double backUnderS(const std::vector<Arrival>& frames, std::uint64_t fromUs) {
    double back = 0;
    for (std::uint64_t at = fromUs; at < fromUs + kSearchUs; at += kStepUs) {
        const std::vector<double> ages = agesMs(frames, at, at + kWindowUs);
        if (ages.empty() || median(ages) >= kMostMs) back = 1e-6 * static_cast<double>(at + kWindowUs - fromUs);
    }
    return back;
}

int modeOfLevels(const std::vector<Arrival>& frames, std::uint64_t fromUs, std::uint64_t toUs) {
    std::array<int, 256> counts{};
    for (const Arrival& frame : frames) {
        if (frame.atUs >= fromUs && frame.atUs < toUs) ++counts[frame.header.level];
    }
    return static_cast<int>(std::ranges::max_element(counts) - counts.begin());
}

}  // namespace

Report ladder(const ScenarioOptions& options) {
    const ServerChild server(options.server, {"--gpu", options.gpu, "--test-frame-bytes", "100000", "--test-frame-ms", "1"});
    Relay relay(server.port(), {{.bytesPerS = kPhases[0].bytesPerS}, {}});

    std::array<std::uint64_t, kPhases.size() + 1> starts{};
    double total = 0;
    for (const Phase& phase : kPhases) total += phase.seconds;
    const std::uint64_t startUs = nowUs();
    Watched watched;
    std::string failed;
    std::thread viewer([&] {
        try {
            watched = watchStream(relay.port(), plainDocument(true), {.untilUs = startUs + static_cast<std::uint64_t>(1e6 * total)});
        } catch (const std::exception& problem) {
            failed = problem.what();
        }
    });
    Progress progress("ladder");
    starts[0] = startUs;
    for (std::size_t i = 0; i < kPhases.size(); ++i) {
        if (i > 0) relay.reshape({{.bytesPerS = kPhases[i].bytesPerS}, {}});
        progress.at(1e-6 * static_cast<double>(starts[i] - startUs) / total, kPhases[i].name);
        starts[i + 1] = starts[i] + static_cast<std::uint64_t>(1e6 * kPhases[i].seconds);
        std::this_thread::sleep_for(std::chrono::microseconds(starts[i + 1] - std::min(starts[i + 1], nowUs())));
    }
    viewer.join();
    if (!failed.empty()) throw Error(failed);

    Report report("ladder");
    report.note("frames of 100 KB at level 0, smaller with the level, offered at 60 a second; link 20 -> 2 -> 0.6 -> 4 MB/s");
    if (!watched.ended.empty()) report.note("the connection " + watched.ended);
    const int first = modeOfLevels(watched.frames, starts[1] - 4'000'000, starts[1]);
    report.shown("level at 20 MB/s", first, "");
    for (const std::size_t i : {1u, 2u}) {
        const std::string step = std::string("down to ") + kPhases[i].name + ": ";
        report.atMost(step + "running median age back under 150 ms after", backUnderS(watched.frames, starts[i]), kAfterDownS, "s");
        report.atMost(step + "median age from 2 s after it on",
                      median(agesMs(watched.frames, starts[i] + static_cast<std::uint64_t>(1e6 * kAfterDownS), starts[i + 1])), kMostMs, "ms");
        report.shown(step + "level most of the time", modeOfLevels(watched.frames, starts[i] + 2'000'000, starts[i + 1]), "");
    }
    const auto again = std::ranges::find_if(watched.frames, [&](const Arrival& frame) { return frame.atUs >= starts[3] && frame.header.level <= first; });
    const double upS = again == watched.frames.end() ? kPhases[3].seconds : 1e-6 * static_cast<double>(again->atUs - starts[3]);
    report.atMost("up to 4 MB/s: the first level again after", upS, kAfterUpS, "s");
    report.shown("up to 4 MB/s: median age", median(agesMs(watched.frames, starts[3] + 2'000'000)), "ms");

    if (!options.svg.empty()) {
        std::vector<TimelinePhase> phases;
        std::vector<TimelinePoint> points;
        const auto seconds = [&](std::uint64_t us) { return 1e-6 * static_cast<double>(us - startUs); };
        for (std::size_t i = 0; i < kPhases.size(); ++i) phases.push_back({seconds(starts[i]), seconds(starts[i + 1]), kPhases[i].name});
        for (const Arrival& frame : watched.frames) points.push_back({seconds(frame.atUs), frame.ageMs, frame.header.level});
        std::ofstream(options.svg) << timelineSvg("A stream on a link that changes", phases, points, kMostMs, static_cast<int>(stream::Ladder::kLevels.size()));
    }
    return report;
}

}  // namespace caustream::bench
