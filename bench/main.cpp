#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "bench/benchmarks.h"

int main(int argc, char** argv) {
    using namespace caustream::bench;
    CLI::App app{"caustream-bench: prints what frames cost. Quote ratios of one run, not milliseconds of different machines."};
    app.require_subcommand(1);
    FrameOptions frame;
    auto* frameCommand = app.add_subcommand("frame", "render times in this process, pass by pass");
    frameCommand->add_option("--scene", frame.scene, "a built-in scene")->capture_default_str();
    frameCommand->add_option("--gpu", frame.gpu, "auto, software, an index or part of a name")->capture_default_str();
    frameCommand->add_option("--frames", frame.frames, "frames counted")->check(CLI::Range(3, 10000))->capture_default_str();
    frameCommand->add_option("--photon-grid", frame.photonGrid, "photons a side")->check(CLI::Range(16, 2048))->capture_default_str();
    frameCommand->add_option("--size", frame.size, "pixels and map texels a side")->check(CLI::Range(64, 2048))->capture_default_str();
    StreamOptions stream;
    auto* streamCommand = app.add_subcommand("stream", "what the socket adds, with a server that runs already");
    streamCommand->add_option("--url", stream.url, "the server")->capture_default_str();
    streamCommand->add_option("--scene", stream.scene, "a built-in scene")->capture_default_str();
    streamCommand->add_option("--frames", stream.frames, "frames counted")->check(CLI::Range(3, 10000))->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    try {
        return frameCommand->parsed() ? frameTime(frame) : streamTime(stream);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "caustream-bench: %s\n", error.what());
        return 1;
    }
}
