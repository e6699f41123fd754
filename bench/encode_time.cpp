#include <array>
#include <cstdio>
#include <ctime>
#include <map>
#include <memory>
#include <vector>

#include "bench/commands.h"
#include "bench/statistics.h"
#include "error.h"
#include "gl/context.h"
#include "gl/shader_library.h"
#include "render/pipeline.h"
#include "scene/builtin_scenes.h"
#include "stream/encoder.h"

namespace caustream::bench {

namespace {

using render::PixelLayout;
using stream::Subsampling;

struct EncodeOptions {
    std::string scene = "sphere", gpu = "auto";
    int frames = 30;            // counted, after a warm-up of a sixth as many
};

struct Way {
    const char* name;
    PixelLayout pixels;
    Subsampling subsampling;
};

constexpr std::array<Way, 6> kWays = {{{"4:4:4, three bytes a pixel", PixelLayout::Rgb, Subsampling::None},
                                       {"4:4:4, four bytes", PixelLayout::Rgbx, Subsampling::None},
                                       {"4:4:4, planes", PixelLayout::Yuv444, Subsampling::None},
                                       {"4:2:0, three bytes a pixel", PixelLayout::Rgb, Subsampling::Half},
                                       {"4:2:0, four bytes", PixelLayout::Rgbx, Subsampling::Half},
                                       {"4:2:0, planes", PixelLayout::Yuv420, Subsampling::Half}}};

// Of all threads of this process: software GL's are among them.
double cpuMs() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct Times {
    std::vector<double> render, read, encode, all;
    std::size_t readBytes = 0, jpegBytes = 0;
};

// Each frame of a moving camera by every way, so that a loaded machine slows all alike.
void compare(render::Pipeline& pipeline, render::Request request, const EncodeOptions& options) {
    std::array<Times, kWays.size()> times;
    stream::Encoder encoder;
    const int warmUp = std::max(2, options.frames / 6);
    for (int i = 0; i < options.frames + warmUp; ++i) {
        request.camera.eye.x += 1e-3f;
        for (std::size_t w = 0; w < kWays.size(); ++w) {
            request.pixels = kWays[w].pixels;
            const double start = cpuMs();
            const render::Frame frame = pipeline.run(request);
            const double drawn = cpuMs();
            stream::WireBuffer jpeg = encoder.encode(frame, {.jpegQuality = 80, .subsampling = kWays[w].subsampling});
            const double done = cpuMs();
            if (i < warmUp) continue;
            double read = 0.0;
            for (const render::StageTime& stage : frame.stats.stages) {
                if (stage.pass == "planar_yuv" || stage.pass == "read_back") read += stage.ms;
            }
            times[w].render.push_back(drawn - start), times[w].encode.push_back(done - drawn);
            times[w].read.push_back(read), times[w].all.push_back(done - start);
            times[w].readBytes = isPlanar(frame.layout) ? frame.pixels.size() : std::size_t{4} * request.width * request.height;
            times[w].jpegBytes = jpeg.size();
        }
    }
    std::printf("%d x %d\n%-28s %10s %10s %10s %10s %10s %8s\n", request.width, request.height, "", "read back", "frame", "to memory", "encode",
                "both", "JPEG");
    for (std::size_t w = 0; w < kWays.size(); ++w) {
        std::printf("%-28s %7zu kB %7.2f ms %7.2f ms %7.2f ms %7.2f ms %5zu kB\n", kWays[w].name, times[w].readBytes / 1000, median(times[w].render),
                    median(times[w].read), median(times[w].encode), median(times[w].all), times[w].jpegBytes / 1000);
    }
    std::fflush(stdout);
}

// A spectral map without loss, as it is and compressed.
void compareMaps(render::Pipeline& pipeline, render::Request request, const EncodeOptions& options) {
    request.target = render::Target::Spectral;
    stream::Encoder encoder;
    for (const bool bands : {false, true}) {
        for (const auto sample : {render::Sample::F16, render::Sample::F32}) {
            request.wavelengthBands = bands, request.sample = sample;
            const render::Frame frame = pipeline.run(request);
            std::array<std::vector<double>, 2> times;
            std::array<std::size_t, 2> bytes{};
            for (int i = 0; i < options.frames; ++i) {
                for (std::size_t way = 0; way < bytes.size(); ++way) {
                    const double start = cpuMs();
                    bytes[way] = encoder.encode(frame, {.encoding = way == 0 ? protocol::Encoding::Raw : protocol::Encoding::Zstd}).size();
                    times[way].push_back(cpuMs() - start);
                }
            }
            std::printf("map of %d bands, %s: raw %zu kB in %.2f ms, zstd %zu kB in %.2f ms\n", frame.bands, sample == render::Sample::F16 ? "f16" : "f32",
                        bytes[0] / 1000, median(times[0]), bytes[1] / 1000, median(times[1]));
        }
    }
}

// Pictures of a stream whose level of the quality ladder goes up and down with every frame: images of the other size are made anew.
void changeSize(render::Pipeline& pipeline, render::Request request, const EncodeOptions& options) {
    std::map<std::pair<bool, bool>, std::vector<double>> times;   // small, after the other size
    const int width = request.width, height = request.height;
    for (int i = 0; i < 4 * options.frames; ++i) {
        const bool small = (i & 2) != 0;
        const auto size = small ? stream::Ladder::scaled({width, height}, stream::Ladder::kWorst) : stream::Ladder::Size{width, height};
        request.width = size.width, request.height = size.height;
        request.camera.eye.x += 1e-3f;
        const double start = cpuMs();
        pipeline.run(request);
        if (i >= 4) times[{small, (i & 1) == 0}].push_back(cpuMs() - start);
    }
    for (const bool small : {false, true}) {
        std::printf("%s: %.2f ms a frame after one of its size, %.2f ms after one of the other\n", small ? "half the sides" : "whole size",
                    median(times[{small, false}]), median(times[{small, true}]));
    }
}

void encodeTime(const EncodeOptions& options) {
    const auto context = gl::Context::create({.gpu = options.gpu});
    gl::ShaderLibrary shaders;
    render::Pipeline pipeline(*context, shaders);
    pipeline.warmUp();
    auto scene = scene::loadBuiltin(options.scene);
    if (!scene) throw Error(scene.error().message);
    render::Request request;
    request.camera = scene->cameras.front();
    request.scene = std::make_shared<const scene::Scene>(std::move(*scene));
    std::printf("%s, scene %s, JPEG at quality 80, medians of %d; CPU time of all threads, \"to memory\" by the clock. Calibration %.1f ms\n",
                context->renderer().c_str(), options.scene.c_str(), options.frames, calibrationMs());
    for (const auto& [width, height] : {std::pair{512, 512}, std::pair{1280, 720}}) {
        request.width = width, request.height = height;
        compare(pipeline, request, options);
        changeSize(pipeline, request, options);
    }
    compareMaps(pipeline, request, options);
}

}  // namespace

void addEncode(CLI::App& app) {
    const auto options = std::make_shared<EncodeOptions>();
    CLI::App* command = app.add_subcommand("encode", "the ways from a drawn picture to a JPEG, and of a map without loss, beside each other");
    command->add_option("--scene", options->scene, "a built-in scene")->capture_default_str();
    command->add_option("--gpu", options->gpu, "auto, software, an index or part of a name")->capture_default_str();
    command->add_option("--frames", options->frames, "frames counted")->check(CLI::Range(3, 10000))->capture_default_str();
    command->callback([options] { encodeTime(*options); });
}

}  // namespace caustream::bench
