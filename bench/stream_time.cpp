#include <algorithm>
#include <cstdio>
#include <memory>
#include <vector>

#include "bench/commands.h"
#include "bench/statistics.h"
#include "client/connection/connection.h"
#include "error.h"

namespace caustream::bench {

namespace {

struct StreamOptions {
    std::string url = "http://127.0.0.1:9720";
    std::string scene = "sphere";
    int frames = 60;
};

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
// Frames of a moving light through the socket: what encoding, sending and decoding add to rendering.
void streamTime(const StreamOptions& options) {
    const auto address = connection::parseAddress(options.url);
    if (!address) throw Error(address.error());
    connection::Connection connection({.address = *address, .clientName = "caustream-bench"});
    const auto set = connection.update({{"scene", {"builtin", options.scene}},
                                        {"transport", {{"photon_grid", 180}, {"wavelengths", 7}, {"map_size", 512}}},
                                        {"stream", {{"width", 512}, {"height", 512}, {"max_fps", 240}}}});
    if (!set) throw Error(set.error().message);
    connection.startStream(false);
    frameOf(connection, 0);

    std::vector<double> total, render, encode, decode, added, hold;
    const int warmUp = std::max(2, options.frames / 6);
    for (int i = 0; i < options.frames + warmUp; ++i) {
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
        added.push_back(ms - 1e-3 * frame.header.renderUs);
    }
    std::printf("scene %s over %s, 512 x 512, 7 wavelengths, medians of %d, calibration %.1f ms\n", options.scene.c_str(),
                options.url.c_str(), options.frames, calibrationMs());
    std::printf("input to decoded frame   %.2f ms\n", median(total));
    std::printf("  render                 %.2f ms\n", median(render));
    std::printf("  encode                 %.2f ms\n", median(encode));
    std::printf("  held for the socket    %.2f ms\n", median(hold));
    std::printf("  decode                 %.2f ms\n", median(decode));
    std::printf("added to rendering       %.2f ms\n", median(added));
}

}  // namespace

void addStream(CLI::App& app) {
    const auto options = std::make_shared<StreamOptions>();
    CLI::App* command = app.add_subcommand("stream", "what the socket adds, with a server that runs already");
    command->add_option("--url", options->url, "the server")->capture_default_str();
    command->add_option("--scene", options->scene, "a built-in scene")->capture_default_str();
    command->add_option("--frames", options->frames, "frames counted")->check(CLI::Range(3, 10000))->capture_default_str();
    command->callback([options] { streamTime(*options); });
}

}  // namespace caustream::bench
