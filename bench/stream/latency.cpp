#include <algorithm>

#include "bench/statistics.h"
#include "bench/stream/scenarios.h"
#include "bench/stream/server_child.h"
#include "client/connection/connection.h"
#include "error.h"

namespace caustream::bench {
namespace {

constexpr double kMostAddedMs = 4;

// Waits for the frame that shows input `seq` or a later one; frames before it are acknowledged and dropped.
connection::Frame frameOf(connection::Connection& connection, std::uint32_t seq) {
    const std::uint64_t deadline = connection::nowUs() + 20'000'000;
    while (connection::nowUs() < deadline) {
        connection.wait(std::chrono::milliseconds(100));
        for (const connection::Event& event : connection.takeEvents()) {
            if (const auto* error = std::get_if<protocol::ErrorMessage>(&event)) throw Error("the server says: " + error->message);
            if (const auto* gone = std::get_if<connection::Disconnected>(&event)) throw Error("no connection: " + gone->why);
        }
        if (auto frame = connection.takeFrame()) {
            connection.acknowledge(*frame, 0);
            if (frame->header.inputSeq >= seq) return std::move(*frame);
        }
    }
    throw Error("no frame within 20 s; is the server busy with other viewers?");
}

// Frames of a moving light, one after the other.
void measure(Report& report, const connection::Address& address, const std::string& scene, int frames, bool judged) {
    connection::Connection connection({.address = address, .clientName = "caustream-bench"});
    const auto set = connection.update({{"scene", {"builtin", scene}},
                                        {"transport", {{"photon_grid", 180}, {"wavelengths", 7}, {"map_size", 512}}},
                                        {"stream", {{"width", 512}, {"height", 512}, {"max_fps", 240}}}});
    if (!set) throw Error(set.error().message);
    connection.startStream(false);
    frameOf(connection, 0);

    std::vector<double> total, render, encode, decode, added, hold;
    const int warmUp = std::max(2, frames / 6);
    for (int i = 0; i < frames + warmUp; ++i) {
        const double x = 0.35 + 1e-3 * i;
        const std::uint64_t start = connection::nowUs();
        const auto seq = connection.input({{"lights", {{"key", {{"position", {x, 1.9, 0.3}}}}}}});
        if (!seq) throw Error(seq.error().message);
        const connection::Frame frame = frameOf(connection, *seq);
        if (i < warmUp) continue;
        const double ms = 1e-3 * static_cast<double>(frame.receivedUs + frame.decodeUs - start);
        total.push_back(ms);
        render.push_back(1e-3 * frame.header.renderUs);
        encode.push_back(1e-3 * frame.header.encodeUs);
        hold.push_back(1e-3 * frame.header.holdUs);
        decode.push_back(1e-3 * frame.decodeUs);
        added.push_back(ms - 1e-3 * (frame.header.renderUs + frame.header.encodeUs));
    }
    report.note("scene " + scene + ", 512 x 512, 7 wavelengths, medians of " + std::to_string(frames) + " moves of the light, each after the picture of the one before");
    report.shown("input to decoded frame", median(total), "ms");
    report.shown("rendering", median(render), "ms");
    report.shown("encoding", median(encode), "ms");
    report.shown("waiting for the renderer", median(hold), "ms");
    report.shown("decoding", median(decode), "ms");
    if (judged) report.atMost("beyond rendering and encoding", median(added), kMostAddedMs, "ms");
    else report.shown("beyond rendering and encoding", median(added), "ms");
    report.shown("calibration loop", calibrationMs(), "ms");
}

}  // namespace

Report latency(const ScenarioOptions& options) {
    const ServerChild server(options.server, {"--gpu", options.gpu});
    Report report("latency");
    measure(report, *connection::parseAddress(server.url()), "sphere", options.frames, true);
    return report;
}

Report added(const connection::Address& address, const std::string& scene, int frames) {
    Report report("added");
    measure(report, address, scene, frames, false);
    return report;
}

}  // namespace caustream::bench
