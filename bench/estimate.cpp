#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "bench/commands.h"
#include "error.h"
#include "gl/context.h"
#include "gl/shader_library.h"
#include "render/pipeline.h"
#include "scene/builtin_scenes.h"

namespace caustream::bench {

namespace {

constexpr int kFiner = 8;   // a side: 64 times the photons

struct EstimateOptions {
    std::vector<std::string> scenes = {"sphere", "prism", "gem", "ring", "bunny", "glass"};
    std::vector<int> grids = {128, 256, 512};
    std::string gpu = "auto", wavelengths = "7";
    int mapSize = 512;
};

struct Traced {
    std::vector<double> luminance;   // of each texel, concentration
    render::ErrorEstimate error;
    render::EnergyLedger ledger;
};

Traced trace(render::Pipeline& pipeline, const scene::Scene& scene, const EstimateOptions& options, int grid, int backLayer) {
    render::Request request;
    request.scene = std::make_shared<const scene::Scene>(scene);
    request.camera = scene.cameras.front();
    request.target = render::Target::Spectral;
    request.sample = render::Sample::F32;
    request.transport.photonGrid = grid;
    request.transport.backLayer = backLayer;
    request.transport.mapSize = options.mapSize;
    request.transport.wavelengths = options.wavelengths == "continuous" ? render::kContinuous : std::stoi(options.wavelengths);
    const render::Frame frame = pipeline.run(request);
    if (!frame.stats.error) throw Error("the map of scene " + scene.name + " has no estimate; does light land in it?");
    std::vector<float> rgb(frame.pixels.size() / sizeof(float));
    std::memcpy(rgb.data(), frame.pixels.data(), rgb.size() * sizeof(float));
    Traced traced{{}, *frame.stats.error, frame.stats.ledger};
    for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) traced.luminance.push_back(0.2126 * rgb[i] + 0.7152 * rgb[i + 1] + 0.0722 * rgb[i + 2]);
    return traced;
}

double relativeL1(const std::vector<double>& map, const std::vector<double>& truth) {
    double difference = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) difference += std::abs(map[i] - truth[i]), sum += truth[i];
    return sum > 0.0 ? difference / sum : 0.0;
}

// The estimate beside the sampling error that the same transport has against itself with 64 times the photons, both with
// the same back layer, as that is no question of sampling.
void judgeEstimate(const EstimateOptions& options) {
    const auto context = gl::Context::create({.gpu = options.gpu});
    gl::ShaderLibrary shaders;
    render::Pipeline pipeline(*context, shaders);
    std::printf("%s, map %d, %s wavelengths; truth: %d times the photons\n", context->renderer().c_str(), options.mapSize,
                options.wavelengths.c_str(), kFiner * kFiner);
    std::printf("%-8s %5s %10s %10s %7s %10s %10s\n", "scene", "grid", "estimate", "truth", "ratio", "spectral", "rejected");
    double worst = 1.0;
    for (const std::string& name : options.scenes) {
        const auto scene = scene::loadBuiltin(name);
        if (!scene) throw Error(scene.error().message);
        for (const int grid : options.grids) {
            const int back = grid > 512 ? 512 : 256;
            const Traced own = trace(pipeline, *scene, options, grid, back);
            const Traced truth = trace(pipeline, *scene, options, kFiner * grid, back);
            const double error = relativeL1(own.luminance, truth.luminance), ratio = error > 0.0 ? own.error.sampling / error : 1.0;
            worst = std::max(worst, std::max(ratio, 1.0 / std::max(ratio, 1e-9)));
            std::printf("%-8s %5d %10.4f %10.4f %7.2f %10.4f %9.2f%%\n", name.c_str(), grid, own.error.sampling, error, ratio,
                        own.error.spectral, 100.0 * own.ledger.rejected / own.ledger.onCasters);
            std::fflush(stdout);
        }
    }
    std::printf("worst factor between estimate and truth: %.2f\n", worst);
}

}  // namespace

void addEstimate(CLI::App& app) {
    const auto options = std::make_shared<EstimateOptions>();
    CLI::App* command = app.add_subcommand("estimate", "the statistics' error estimate beside the true sampling error");
    command->add_option("--scene", options->scenes, "built-in scenes")->capture_default_str();
    command->add_option("--grid", options->grids, "photons a side")->check(CLI::Range(16, 1024))->capture_default_str();
    command->add_option("--map", options->mapSize, "texels a side")->check(CLI::Range(64, 2048))->capture_default_str();
    command->add_option("--wavelengths", options->wavelengths, "1 to 64, or continuous")
        ->check(CLI::Range(1, 64) | CLI::IsMember({"continuous"}))->capture_default_str();
    command->add_option("--gpu", options->gpu, "auto, software, an index or part of a name")->capture_default_str();
    command->callback([options] { judgeEstimate(*options); });
}

}  // namespace caustream::bench
