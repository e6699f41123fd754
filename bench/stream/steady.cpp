#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>

#include "bench/progress.h"
#include "bench/statistics.h"
#include "bench/stream/relay.h"
#include "bench/stream/scenarios.h"
#include "bench/stream/server_child.h"
#include "bench/stream/watch.h"
#include "client/connection/connection.h"

namespace caustream::bench {
namespace {

using connection::nowUs;

constexpr double kFrameBytes = 100'000, kBytesPerS = 2e6, kOfferedPerS = 60;
constexpr std::uint64_t kFarUs = 100'000;                // one way
constexpr std::uint64_t kSettleUs = 3'000'000;           // the window has grown by then
constexpr double kShortMinutes = 0.5;

// Bytes a second, from the first frame's end to the last one's.
double bytesPerS(const std::vector<Arrival>& frames, std::uint64_t fromUs) {
    double bytes = 0;
    std::uint64_t first = 0, last = 0;
    for (const Arrival& frame : frames) {
        if (frame.atUs < fromUs) continue;
        if (first != 0) bytes += static_cast<double>(frame.bytes);
        first = first == 0 ? frame.atUs : first;
        last = frame.atUs;
    }
    return last > first ? 1e6 * bytes / static_cast<double>(last - first) : 0;
}

struct Run {
    Watched watched;
    std::uint64_t fromUs = 0;
    std::vector<double> residentMib;   // once a second
};

Run play(const ServerChild& server, LinkShape down, LinkShape up, double minutes, const char* what) {
    Relay relay(server.port(), {down, up});
    const auto lengthUs = static_cast<std::uint64_t>(minutes * 60e6) + kSettleUs;
    Run run{.fromUs = nowUs() + kSettleUs};
    const std::uint64_t until = nowUs() + lengthUs;
    std::atomic<bool> over = false;
    std::thread memory([&] {
        Progress progress(what);
        for (std::uint64_t next = run.fromUs; !over; std::this_thread::sleep_for(std::chrono::milliseconds(100))) {
            if (nowUs() < next) continue;
            run.residentMib.push_back(server.residentMib());
            progress.at(1.0 - static_cast<double>(until - std::min(until, nowUs())) / static_cast<double>(lengthUs));
            next += 1'000'000;
        }
    });
    try {
        run.watched = watchStream(relay.port(), plainDocument(false), {.inputsPerS = kOfferedPerS, .untilUs = until});
    } catch (...) {
        over = true;
        memory.join();
        throw;
    }
    over = true;
    memory.join();
    return run;
}

// What the last fifth holds more than the second, in per cent: the first is for what is made once.
double growthPercent(const std::vector<double>& residentMib) {
    const std::size_t fifth = residentMib.size() / 5;
    if (fifth == 0) return 0;
    const auto part = [&](std::size_t i) {
        const auto from = residentMib.begin() + static_cast<std::ptrdiff_t>(i * fifth);
        return median({from, from + static_cast<std::ptrdiff_t>(fifth)});
    };
    return 100.0 * (part(4) / part(1) - 1.0);
}

}  // namespace

Report steady(const ScenarioOptions& options) {
    const double minutes = options.minutes > 0 ? options.minutes : kShortMinutes;
    const ServerChild server(options.server, {"--gpu", options.gpu, "--test-frame-bytes", "100000", "--test-frame-ms", "1"});
    Report report("steady");
    char text[160];
    std::snprintf(text, sizeof text, "frames of 100 KB offered at 60 a second through a link of 2 MB/s, %.3g minutes", minutes);
    report.note(text);

    const double sendMs = 1e3 * kFrameBytes / kBytesPerS;
    const Run near = play(server, {.bytesPerS = kBytesPerS}, {}, minutes, "steady");
    if (!near.watched.ended.empty()) report.note("the connection " + near.watched.ended);
    const std::vector<double> ages = agesMs(near.watched.frames, near.fromUs);
    report.atMost("frame age, median, in times of sending one", ages.empty() ? 1e9 : median(ages) / sendMs, 2.5, "");
    report.shown("frame age, median", median(ages), "ms");
    report.shown("frame age, 95%", quantile(ages, 0.95), "ms");
    report.atLeast("share of the link used", bytesPerS(near.watched.frames, near.fromUs) / kBytesPerS, 0.9, "");
    report.atMost("server's memory, growth over the run", growthPercent(near.residentMib), 2.0, "%");
    report.shown("server's memory", near.residentMib.empty() ? 0 : near.residentMib.back(), "MiB");

    const Run far = play(server, {kBytesPerS, kFarUs}, {0, kFarUs}, std::min(minutes, kShortMinutes), "steady, far away");
    if (!far.watched.ended.empty()) report.note("far away, the connection " + far.watched.ended);
    report.atLeast("200 ms round trip: share of the link used", bytesPerS(far.watched.frames, far.fromUs) / kBytesPerS, 0.75, "");
    report.shown("200 ms round trip: frame age, median", median(agesMs(far.watched.frames, far.fromUs)), "ms");
    return report;
}

}  // namespace caustream::bench
