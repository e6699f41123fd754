#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "bench/progress.h"
#include "bench/statistics.h"
#include "bench/stream/glb_file.h"
#include "bench/stream/mutation.h"
#include "bench/stream/scenarios.h"
#include "bench/stream/server_child.h"
#include "bench/stream/watch.h"
#include "client/connection/connection.h"

namespace caustream::bench {
namespace {

using connection::nowUs;
using e2e::RawClient;
using protocol::Json;

constexpr int kViewers = 8;
constexpr double kShortMinutes = 3;
constexpr double kFirstShare = 5.0 / 30.0;          // minute five of thirty
constexpr double kMostGrowthPercent = 5;
// In the first minutes allocators still take what they will keep: a short run only finds what is lost at every visit.
constexpr double kLongMinutes = 10, kMostGrowthShortPercent = 20;
// Images that are made when something is first done, and kept; a leak is one or more at every visit, of hundreds.
constexpr double kMostObjectsMore = 8;
constexpr int kShownWithinMs = 20'000;              // a lost acknowledgement shows nothing, ever
constexpr std::array kScenes = {"sphere", "prism", "gem", "newton"};

struct Counts {
    std::atomic<int> joined{0}, frames{0}, uploads{0}, inputs{0}, unshown{0}, refused{0}, lost{0};
};

// A visit: joins, shows a scene or uploads one, moves things for a while, takes a still, leaves one way or the other.
class Visitor {
   public:
    Visitor(int port, std::uint32_t seed, Counts& counts) : port_(port), dice_(seed), counts_(counts) {}

    void visit(std::uint64_t untilUs) {
        RawClient client(port_);
        client.hello({{"max_inflight", 2 + dice_.below(3)}, {"caps", {"jpeg", "png", "raw", "f16", "f32"}}});
        ++counts_.joined;
        const int side = 32 + 32 * static_cast<int>(dice_.below(4));
        Json document = plainDocument(dice_.below(2) == 0, side);
        document["scene"] = {"builtin", kScenes[dice_.below(kScenes.size())]};
        if (dice_.below(8) == 0) document["transport"]["mode"] = "traced";
        expectOk(client.update(document));
        const std::size_t rounds = 1 + dice_.below(3);
        for (std::size_t round = 0; round < rounds && nowUs() < untilUs; ++round) {
            if (dice_.below(3) == 0) show(client, salted(builtinGlb(kScenes[dice_.below(kScenes.size())]), nextSalt_++));
            stream(client, untilUs);
            still(client);
            if (dice_.below(4) == 0) expectOk(client.ask({{"op", "stream.pause"}}));
        }
    }

   private:
    void expectOk(const Json& reply) { counts_.refused += !reply.is_object() || reply.value("op", "") != "ok"; }

    void show(RawClient& client, const std::string& file) {
        expectOk(upload(client, file));
        expectOk(client.update({{"scene", {"asset", sha256(file)}}, {"lights", nullptr}, {"materials", nullptr}, {"camera", nullptr}}));
        ++counts_.uploads;
    }

    // Moves the camera or the light, then waits until the last move is in a picture.
    void stream(RawClient& client, std::uint64_t untilUs) {
        expectOk(client.ask({{"op", "stream.start"}, {"stats", true}}));
        const bool light = dice_.below(2) == 0;
        WatchOptions options{.inputsPerS = 5.0 + static_cast<double>(dice_.below(20)),
                             .untilUs = std::min(untilUs, nowUs() + 500'000 + 1000 * dice_.below(5000)),
                             .firstSeq = seq_};
        options.pose = [light](std::uint32_t seq) {
            const double angle = 0.05 * seq;
            if (light) return Json{{"lights", {{"key", {{"position", {0.3 * std::sin(angle), 1.9, 0.3 * std::cos(angle)}}}}}}};
            return Json{{"camera", {{"eye", {2.0 * std::sin(angle), 1.5, 2.0 * std::cos(angle)}}}}};
        };
        Watched watched = watch(client, options);
        counts_.inputs += static_cast<int>(watched.lastInput - seq_ + 1);
        counts_.frames += static_cast<int>(watched.frames.size());
        seq_ = watched.lastInput + 1;
        std::uint32_t shown = watched.lastShown;
        for (const std::uint64_t patience = nowUs() + 1000 * kShownWithinMs; shown < watched.lastInput && watched.ended.empty() && nowUs() < patience;) {
            const auto frame = client.frame(200);
            if (!frame) continue;
            client.ack(frame->header.frameSeq);
            shown = frame->header.inputSeq;
            ++counts_.frames;
        }
        if (!watched.ended.empty()) {
            ++counts_.lost;
            std::fprintf(stderr, "soak: a viewer was %s\n", watched.ended.c_str());
        }
        counts_.unshown += watched.ended.empty() && shown < watched.lastInput;
    }

    void still(RawClient& client) {
        client.json({{"op", "frame.request"}, {"id", 500'000 + seq_}, {"still", true}});
        for (const std::uint64_t patience = nowUs() + 1000 * kShownWithinMs; nowUs() < patience;) {
            const auto frame = client.frame(200);
            if (!frame) continue;
            client.ack(frame->header.frameSeq);
            ++counts_.frames;
            // A frame of the stream may come before any answer has.
            if (client.lastReply.is_object() && client.lastReply.value("id", 0u) == 500'000 + seq_ && client.lastReply.at("frame_seq") == frame->header.frameSeq) return;
        }
        ++counts_.unshown;
    }

    int port_;
    Dice dice_;
    Counts& counts_;
    std::uint32_t seq_ = 1;
    std::uint64_t nextSalt_ = std::uint64_t{dice_.below(0xffffffff)} << 20;
};

// Every scene in every way once, so that what is made once is there before anything is compared.
void warmUp(int port) {
    RawClient client(port);
    client.hello();
    for (const char* scene : kScenes) {
        for (const char* mode : {"refined", "traced", "auto"}) {
            Json document = plainDocument(false, 128);
            document["scene"] = {"builtin", scene};
            document["transport"]["mode"] = mode;
            client.update(document);
            for (const bool still : {false, true}) client.requestFrame(still, still);
        }
    }
}

struct Resources {
    double residentMib = 0, descriptors = 0, glObjects = 0;
};

// Once everyone has left: what the server holds by itself. Nothing of one that has ended.
Resources atRest(const ServerChild& server) {
    if (!server.alive()) return {};
    for (int i = 0; i < 100 && server.metric("caustream_sessions").value_or(0) > 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    std::this_thread::sleep_for(std::chrono::milliseconds(1000));
    return {server.residentMib(), static_cast<double>(server.descriptors()), server.metric("caustream_gl_objects").value_or(0)};
}

void play(int port, std::uint64_t untilUs, std::uint32_t seed, Counts& counts) {
    std::vector<std::thread> viewers;
    for (int i = 0; i < kViewers; ++i) {
        viewers.emplace_back([&, i] {
            Visitor visitor(port, seed + static_cast<std::uint32_t>(i), counts);
            while (nowUs() < untilUs) {
                try {
                    visitor.visit(untilUs);
                } catch (const std::exception& problem) {
                    ++counts.lost;
                    std::fprintf(stderr, "soak: a viewer was lost: %s\n", problem.what());
                    std::this_thread::sleep_for(std::chrono::milliseconds(200));
                }
            }
        });
    }
    for (std::thread& viewer : viewers) viewer.join();
}

}  // namespace

Report soak(const ScenarioOptions& options) {
    const double minutes = options.minutes > 0 ? options.minutes : kShortMinutes;
    const ServerChild server(options.server, {"--gpu", options.gpu, "--max-sessions", "16",   // who leaves may not be gone yet
                                               "--asset-cache-mb", "8"});                    // full within minutes, not hours
    const auto lengthUs = static_cast<std::uint64_t>(minutes * 60e6);
    const auto firstUs = static_cast<std::uint64_t>(kFirstShare * static_cast<double>(lengthUs));
    warmUp(server.port());
    Counts counts;
    const std::uint64_t start = nowUs();
    std::vector<std::pair<std::uint64_t, double>> residentMib;
    std::atomic<bool> over = false;
    std::thread sampler([&] {
        Progress progress("soak");
        while (!over) {
            residentMib.emplace_back(nowUs() - start, server.residentMib());
            progress.at(std::min(1.0, static_cast<double>(nowUs() - start) / static_cast<double>(lengthUs)));
            std::this_thread::sleep_for(std::chrono::milliseconds(250));
        }
    });
    // Everyone leaves once on the way, so that what the server holds by itself can be compared with the end.
    play(server.port(), start + firstUs, 20261128, counts);
    const Resources early = atRest(server);
    play(server.port(), start + lengthUs, 20271128, counts);
    over = true;
    sampler.join();
    const Resources late = atRest(server);

    const auto around = [&](double share) {   // a tenth of the run
        std::vector<double> values;
        for (const auto& [us, mib] : residentMib) {
            if (std::abs(static_cast<double>(us) / static_cast<double>(lengthUs) - share) < 0.05) values.push_back(mib);
        }
        return median(values);
    };
    Report report("soak");
    report.note("eight viewers that join, upload, move and leave, " + std::to_string(minutes) + " minutes");
    const double first = around(kFirstShare), last = around(0.95);
    report.shown("server's memory after a sixth of the time (minute 5 of 30)", first, "MiB");
    report.shown("server's memory at the end", last, "MiB");
    report.atMost("server's memory, growth in between", 100.0 * (last / first - 1.0), minutes < kLongMinutes ? kMostGrowthShortPercent : kMostGrowthPercent, "%");
    report.atMost("descriptors more, with no viewer, than after a sixth", late.descriptors - early.descriptors, 0, "");
    report.atMost("GL objects more, with no viewer, than after a sixth", late.glObjects - early.glObjects, kMostObjectsMore, "");
    report.shown("GL objects with no viewer", late.glObjects, "");
    report.atMost("server crashes", server.alive() ? 0 : 1, 0, "");
    report.atMost("last moves and stills that no picture showed", counts.unshown, 0, "");
    report.atMost("requests refused", counts.refused, 0, "");
    report.atMost("connections lost", counts.lost, 0, "");
    report.shown("visits", counts.joined, "");
    report.shown("uploads", counts.uploads, "");
    report.shown("moves", counts.inputs, "");
    report.shown("frames", counts.frames, "");
    return report;
}

}  // namespace caustream::bench
