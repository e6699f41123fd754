#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <vector>

#include "bench/accuracy/subject.h"
#include "bench/commands.h"
#include "bench/statistics.h"
#include "error.h"
#include "gl/context.h"
#include "gl/shader_library.h"
#include "render/pipeline.h"
#include "scene/builtin_scenes.h"

namespace caustream::bench {

namespace {

struct FrameOptions {
    std::string scene = "sphere", gpu = "auto";
    int frames = 30;            // counted, after a warm-up of a sixth as many
    int photonGrid = 180;       // about 25,500 photons on the sphere
    int size = 512;             // of picture and map
};

struct Measured {
    double ms = 0;                            // median of whole frames
    std::map<std::string, double> stages;     // median of each pass
    std::uint32_t photons = 0;
};

enum class Move { Light, Camera };

Measured measure(render::Pipeline& pipeline, const scene::Scene& scene, const FrameOptions& options, int wavelengths, Move move) {
    render::Request request;
    request.camera = scene.cameras.front();
    request.width = request.height = options.size;
    request.transport.mapSize = options.size;
    request.transport.photonGrid = options.photonGrid;
    request.transport.wavelengths = wavelengths;
    request.transport.forceDispersive = wavelengths > 1;
    request.scene = std::make_shared<const scene::Scene>(scene);
    std::vector<double> whole;
    std::map<std::string, std::vector<double>> stages;
    Measured measured;
    const int warmUp = std::max(2, options.frames / 6);
    for (int i = 0; i < options.frames + warmUp; ++i) {
        if (move == Move::Light) {
            scene::Scene moved = scene;
            moved.lights.front().position.x += 1e-3f * static_cast<float>(i + 1);
            request.scene = std::make_shared<const scene::Scene>(std::move(moved));
        } else {
            request.camera.eye.x += 1e-3f;
        }
        const render::Frame frame = pipeline.run(request);
        if (i < warmUp) continue;
        whole.push_back(frame.stats.renderMs);
        for (const render::StageTime& stage : frame.stats.stages) stages[stage.pass].push_back(stage.ms);
        measured.photons = frame.stats.photons;
    }
    measured.ms = median(whole);
    for (const auto& [name, times] : stages) measured.stages[name] = median(times);
    return measured;
}

void print(const char* what, const Measured& m) {
    std::printf("%-34s %8.2f ms  %7u photons |", what, m.ms, m.photons);
    for (const auto& [name, ms] : m.stages) std::printf(" %s %.2f", name.c_str(), ms);
    std::printf("\n");
    std::fflush(stdout);
}

// Whole frames through the pipeline after a light move and after a camera move.
void frameTime(const FrameOptions& options) {
    const auto context = gl::Context::create({.gpu = options.gpu});
    gl::ShaderLibrary shaders;
    render::Pipeline pipeline(*context, shaders);
    pipeline.warmUp();
    auto loaded = scene::loadBuiltin(options.scene);
    if (!loaded) throw Error(loaded.error().message);
    const scene::Scene scene = std::move(*loaded);

    std::printf("%s, scene %s, %d x %d, map %d, photon grid %d, medians of %d\n", context->renderer().c_str(),
                options.scene.c_str(), options.size, options.size, options.size, options.photonGrid, options.frames);
    std::printf("calibration: fixed loop %.1f ms\n", calibrationMs());
    const Measured one = measure(pipeline, scene, options, 1, Move::Light);
    print("light move, 1 wavelength", one);
    const Measured seven = measure(pipeline, scene, options, 7, Move::Light);
    print("light move, 7 wavelengths", seven);
    const Measured many = measure(pipeline, scene, options, 21, Move::Light);
    print("light move, 21 wavelengths", many);
    const Measured far = measure(pipeline, withShare(scene, 0.025), options, 7, Move::Light);
    print("light move, 7, 2.5% of the cone", far);
    const Measured near = measure(pipeline, withShare(scene, 0.33), options, 7, Move::Light);
    print("light move, 7, 33% of the cone", near);
    const Measured camera = measure(pipeline, scene, options, 7, Move::Camera);
    print("camera move, 7 wavelengths", camera);
    std::printf("calibration: fixed loop %.1f ms\n", calibrationMs());

    std::printf("21 / 7 wavelengths       %.2f\n", many.ms / seven.ms);
    std::printf("each further one         %.1f ns a photon and wavelength\n", 1e6 * (many.ms - seven.ms) / (14.0 * many.photons));
    std::printf("33%% / 2.5%% of the cone   %.2f\n", near.ms / far.ms);
    std::printf("camera / light move      %.2f\n", camera.ms / seven.ms);
}

}  // namespace

void addFrame(CLI::App& app) {
    const auto options = std::make_shared<FrameOptions>();
    CLI::App* command = app.add_subcommand("frame", "render times in this process, pass by pass");
    command->add_option("--scene", options->scene, "a built-in scene")->capture_default_str();
    command->add_option("--gpu", options->gpu, "auto, software, an index or part of a name")->capture_default_str();
    command->add_option("--frames", options->frames, "frames counted")->check(CLI::Range(3, 10000))->capture_default_str();
    command->add_option("--photon-grid", options->photonGrid, "photons a side")->check(CLI::Range(16, 2048))->capture_default_str();
    command->add_option("--size", options->size, "pixels and map texels a side")->check(CLI::Range(64, 2048))->capture_default_str();
    command->callback([options] { frameTime(*options); });
}

}  // namespace caustream::bench
