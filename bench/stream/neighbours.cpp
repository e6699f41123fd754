#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <thread>
#include <vector>

#include "bench/progress.h"
#include "bench/statistics.h"
#include "bench/stream/mutation.h"
#include "bench/stream/scenarios.h"
#include "bench/stream/server_child.h"
#include "bench/stream/watch.h"
#include "client/connection/connection.h"
#include "error.h"

namespace caustream::bench {
namespace {

using connection::nowUs;
using e2e::Message;
using e2e::RawClient;
using protocol::Json;

constexpr int kHealthy = 5;
constexpr double kInputsPerS = 20;
constexpr double kFloodPerS = 10'000, kChunksPerS = 1'900;   // the server takes 2,000 chunks a second
constexpr std::size_t kUploadBytes = 64u << 20;
constexpr std::uint64_t kWarmUpUs = 3'000'000;
constexpr double kShortMinutes = 0.5;   // of each kind
constexpr int kRounds = 3;

void sleepMs(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

// A connection that does `what` until it is closed or `stop`; then another one.
void again(int port, const std::atomic<bool>& stop, const std::function<void(RawClient&)>& what) {
    while (!stop) {
        try {
            RawClient client(port);
            client.hello();
            client.update(plainDocument(false));
            what(client);
        } catch (const std::exception&) {
            sleepMs(20);   // turned away: a hostile client asks again
        }
    }
}

// Everything that has come; false once the server has closed.
bool readAll(RawClient& client) {
    while (true) {
        const Message message = client.next(0);
        if (message.kind == Message::Kind::Close) return false;
        if (message.kind == Message::Kind::Silence) return true;
    }
}

// Streams, moves its camera, and reads nothing.
void stall(RawClient& client, const std::atomic<bool>& stop) {
    client.json({{"op", "stream.start"}, {"id", 1'000'000}});
    for (std::uint32_t seq = 1; !stop && seq < 31 * 20; ++seq) {
        client.json({{"op", "input"}, {"seq", seq}, {"t_us", nowUs()}, {"camera", {{"fov_y_deg", 40 + seq % 20}}}});
        sleepMs(50);
    }
}

// `perS` messages a second, in lumps of 5 ms, until the server closes.
void pour(RawClient& client, const std::atomic<bool>& stop, double perS, const std::function<bool(int)>& send) {
    const std::uint64_t start = nowUs();
    for (int sent = 0; !stop;) {
        const int due = static_cast<int>(1e-6 * static_cast<double>(nowUs() - start) * perS);
        while (sent < due) {
            if (!send(sent++)) return;
        }
        if (!readAll(client)) return;
        sleepMs(5);
    }
}

void flood(RawClient& client, const std::atomic<bool>& stop, std::atomic<std::uint64_t>& sent) {
    pour(client, stop, kFloodPerS, [&](int i) {
        ++sent;
        switch (i % 3) {
            case 0: client.json({{"op", "ping"}, {"t_us", i}}); break;
            case 1: client.json({{"op", "input"}, {"seq", i + 1}, {"t_us", i}, {"camera", {{"fov_y_deg", 30 + i % 30}}}}); break;
            default: client.json({{"op", "update"}, {"id", i + 1}, {"patch", {{"camera", {{"fov_y_deg", 30 + i % 30}}}}}});
        }
        return true;
    });
}

void uploadByByte(RawClient& client, const std::atomic<bool>& stop, std::atomic<std::uint64_t>& sent) {
    const Json offer = client.ask({{"op", "asset.begin"}, {"sha256", std::string(64, 'a')}, {"size", kUploadBytes}, {"mime", "model/gltf-binary"}});
    if (offer.value("op", "") != "ok") return sleepMs(100);
    const std::uint32_t asset = offer.at("asset");
    pour(client, stop, kChunksPerS, [&](int i) {
        client.send(0x2, validChunk(asset, static_cast<std::uint64_t>(i), std::string(1, '\0')));
        ++sent;
        return true;
    });
}

struct Seen {
    std::array<std::vector<double>, kHealthy> agesMs;
    double seconds = 0;

    double framesPerS(std::size_t viewer) const { return static_cast<double>(agesMs[viewer].size()) / seconds; }
};

void watchHealthy(int port, double seconds, Seen& seen) {
    const std::uint64_t from = nowUs() + kWarmUpUs, until = from + static_cast<std::uint64_t>(1e6 * seconds);
    std::array<std::string, kHealthy> failed;
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < kHealthy; ++i) {
        threads.emplace_back([&, i] {
            try {
                // Each at a time of its own: alone, none waits for another's frame, whoever connected first.
                const auto phaseUs = static_cast<std::uint64_t>(1e6 / kInputsPerS * static_cast<double>(i) / kHealthy);
                const Watched watched = watchStream(port, plainDocument(false), {.inputsPerS = kInputsPerS, .untilUs = until, .phaseUs = phaseUs});
                if (!watched.ended.empty()) failed[i] = "a healthy viewer was " + watched.ended;
                const std::vector<double> ages = agesMs(watched.frames, from);
                seen.agesMs[i].insert(seen.agesMs[i].end(), ages.begin(), ages.end());
            } catch (const std::exception& problem) {
                failed[i] = problem.what();
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    seen.seconds += seconds;
    for (const std::string& problem : failed) {
        if (!problem.empty()) throw Error(problem);
    }
}

}  // namespace

Report neighbours(const ScenarioOptions& options) {
    const double minutes = options.minutes > 0 ? options.minutes : kShortMinutes;
    const ServerChild server(options.server, {"--gpu", options.gpu, "--test-frame-bytes", "30000", "--test-frame-ms", "4"});
    Progress progress("neighbours");
    const double seconds = 60 * minutes / kRounds;
    Seen alone, beside;
    std::atomic<std::uint64_t> flooded = 0, uploaded = 0;
    // In turn, so that a machine that warms up or has other work does not count for one side only.
    for (int round = 0; round < kRounds; ++round) {
        progress.at((2.0 * round) / (2 * kRounds), "five alone");
        watchHealthy(server.port(), seconds, alone);
        progress.at((2.0 * round + 1) / (2 * kRounds), "five beside three that behave badly");
        std::atomic<bool> stop = false;
        std::array<std::thread, 3> bad = {
            std::thread([&] { again(server.port(), stop, [&](RawClient& client) { stall(client, stop); }); }),
            std::thread([&] { again(server.port(), stop, [&](RawClient& client) { flood(client, stop, flooded); }); }),
            std::thread([&] { again(server.port(), stop, [&](RawClient& client) { uploadByByte(client, stop, uploaded); }); })};
        std::string failed;
        try {
            watchHealthy(server.port(), seconds, beside);
        } catch (const std::exception& problem) {
            failed = problem.what();
        }
        stop = true;
        for (std::thread& thread : bad) thread.join();
        if (!failed.empty()) throw Error(failed);
    }

    Report report("neighbours");
    report.note("five viewers at 20 frames a second of 30 KB and 4 ms, alone and beside one that stalls, one that floods, one that uploads byte by byte");
    const double badSeconds = kRounds * (seconds + 1e-6 * kWarmUpUs);
    double rate = 1, age = 1;
    std::vector<double> rates, ages, agesBeside;
    for (std::size_t i = 0; i < kHealthy; ++i) {
        rates.push_back(alone.framesPerS(i));
        ages.push_back(median(alone.agesMs[i]));
        agesBeside.push_back(median(beside.agesMs[i]));
        rate = std::min(rate, beside.framesPerS(i) / alone.framesPerS(i));
        age = std::max(age, agesBeside.back() / ages.back());
    }
    report.shown("frames a second alone, median", median(rates), "1/s");
    report.shown("frame age alone, median", median(ages), "ms");
    report.shown("frame age beside them, median", median(agesBeside), "ms");
    report.atLeast("frame rate beside them, the worst viewer's share", rate, 0.9, "");
    report.atMost("frame age beside them, the worst viewer's, in times of alone", age, 1.2, "");
    report.shown("messages of the flood", static_cast<double>(flooded) / badSeconds, "1/s");
    report.shown("one-byte chunks", static_cast<double>(uploaded) / badSeconds, "1/s");
    return report;
}

}  // namespace caustream::bench
