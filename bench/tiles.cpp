#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
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

struct TilesOptions {
    std::vector<std::string> scenes;
    std::string gpu = "auto";
    int frames = 10, size = 512, quality = 80;
};

enum class Move { Light, Camera, Glass, Rest };
constexpr std::array<std::pair<Move, const char*>, 4> kMoves = {
    {{Move::Light, "light"}, {Move::Camera, "camera"}, {Move::Glass, "glass"}, {Move::Rest, "at rest"}}};

// One step of a hand: a centimetre a frame, half a degree, a thousandth of the index.
void step(Move move, scene::Scene& scene, render::Request& request) {
    switch (move) {
        case Move::Light: scene.lights.front().position.x += 0.01f; break;
        case Move::Camera: {
            scene::Camera& camera = request.camera;
            const glm::vec3 away = camera.eye - camera.target;
            const float cosine = std::cos(0.00873f), sine = std::sin(0.00873f);
            camera.eye = camera.target + glm::vec3(cosine * away.x + sine * away.z, away.y, cosine * away.z - sine * away.x);
            break;
        }
        case Move::Glass:
            for (scene::Material& material : scene.materials) {
                if (!material.caster) continue;
                const double n = optics::refractiveIndex(material.dispersion, 587.56) + 1e-3;
                material.dispersion = optics::Cauchy{n - 0.004 / (0.58756 * 0.58756), 0.004};
            }
            break;
        case Move::Rest: break;
    }
    request.scene = std::make_shared<const scene::Scene>(scene);
}

struct Changes {
    double share = 0.0;           // of tiles with a pixel that changed
    render::Frame tiles;          // those, one below the other: what a codec would be given
};

Changes changesOf(const render::Frame& before, const render::Frame& now, int side) {
    Changes changes;
    changes.tiles.width = side;
    int all = 0, changed = 0;
    for (int y = 0; y + side <= now.height; y += side) {
        for (int x = 0; x + side <= now.width; x += side, ++all) {
            const auto row = [&](const render::Frame& frame, int line) {
                return frame.pixels.data() + 3 * (static_cast<std::size_t>(y + line) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(x));
            };
            const std::size_t bytes = 3 * static_cast<std::size_t>(side);
            bool same = true;
            for (int line = 0; line < side && same; ++line) same = std::memcmp(row(before, line), row(now, line), bytes) == 0;
            if (same) continue;
            ++changed;
            for (int line = 0; line < side; ++line) changes.tiles.pixels.insert(changes.tiles.pixels.end(), row(now, line), row(now, line) + bytes);
        }
    }
    changes.tiles.height = changed * side;
    changes.share = static_cast<double>(changed) / all;
    return changes;
}

void measure(render::Pipeline& pipeline, const std::string& name, const TilesOptions& options) {
    auto loaded = scene::loadBuiltin(name);
    if (!loaded) throw Error(loaded.error().message);
    for (const auto& [move, title] : kMoves) {
        scene::Scene scene = *loaded;
        render::Request request;
        request.camera = scene.cameras.front();
        request.transport.mode = render::Mode::Auto;
        request.width = request.height = options.size;
        request.converge = move == Move::Rest;
        stream::Encoder encoder;
        const auto bytes = [&](const render::Frame& frame) {
            return frame.height == 0 ? 0.0 : double(encoder.encode(frame, {.jpegQuality = options.quality}).size() - protocol::kFrameHeaderBytes);
        };
        std::vector<double> small, large, whole, parts;
        render::Frame before;
        for (int i = 0; i < options.frames + 3; ++i) {
            step(move, scene, request);
            render::Frame now = pipeline.run(request);
            if (i >= 3) {
                const Changes changes = changesOf(before, now, 16);
                small.push_back(changes.share), large.push_back(changesOf(before, now, 64).share);
                whole.push_back(bytes(now)), parts.push_back(bytes(changes.tiles));
            }
            before = std::move(now);
        }
        std::printf("%-10s %-8s %6.0f%% %8.0f%% %9.1f kB %8.1f kB %6.2f\n", name.c_str(), title, 100.0 * median(small), 100.0 * median(large),
                    1e-3 * median(whole), 1e-3 * median(parts), median(parts) / median(whole));
        std::fflush(stdout);
    }
}

void tiles(const TilesOptions& options) {
    const auto context = gl::Context::create({.gpu = options.gpu});
    gl::ShaderLibrary shaders;
    render::Pipeline pipeline(*context, shaders);
    std::printf("%s, %d x %d, JPEG 4:4:4 at quality %d, medians of %d frames\n%-19s %7s %9s %12s %11s %6s\n", context->renderer().c_str(), options.size,
                options.size, options.quality, options.frames, "tiles that changed", "16^2", "64^2", "whole", "16^2 alone", "ratio");
    std::vector<std::string> names = options.scenes;
    if (names.empty()) {
        for (const scene::BuiltinScene& scene : scene::builtinScenes()) names.emplace_back(scene.name);
    }
    for (const std::string& name : names) measure(pipeline, name, options);
}

}  // namespace

void addTiles(CLI::App& app) {
    const auto options = std::make_shared<TilesOptions>();
    CLI::App* command = app.add_subcommand("tiles", "how much of a picture changes from frame to frame, and what sending only that would save");
    command->add_option("--scene", options->scenes, "built-in scenes; all of them without it");
    command->add_option("--gpu", options->gpu, "auto, software, an index or part of a name")->capture_default_str();
    command->add_option("--frames", options->frames, "frames counted")->check(CLI::Range(3, 1000))->capture_default_str();
    command->add_option("--size", options->size, "pixels a side")->check(CLI::Range(64, 2048))->capture_default_str();
    command->add_option("--quality", options->quality, "of the JPEGs")->check(CLI::Range(1, 100))->capture_default_str();
    command->callback([options] { tiles(*options); });
}

}  // namespace caustream::bench
