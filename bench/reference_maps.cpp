// caustream-bench reference: traces a scene exactly and writes what lands as NumPy arrays with a JSON that explains them.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/commands.h"
#include "bench/reference/npy.h"
#include "bench/reference/tracer.h"
#include "error.h"
#include "gl/context.h"
#include "gl/shader_library.h"
#include "render/key_light.h"
#include "render/pipeline.h"
#include "scene/builtin_scenes.h"

namespace caustream::bench {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using tracer::Settings;

struct ReferenceOptions {
    std::string scene = "sphere", out, cache, observer = "cie";
    std::vector<double> window;
    int cells = 256, mapSize = 0;
    bool thinWallsAbsent = false, mirrorsReceive = false;
    Settings settings{.wavelengthsNm = {380, 430, 480, 530, 580, 630, 680}, .photons = 1u << 23};
};

struct Subject {
    tracer::World world;
    std::optional<scene::Scene> scene;       // nothing for a JSON of tests/reference
    std::string stem;                        // of the files written, and of those beside a JSON
};

scene::Scene loadScene(const std::string& name) {
    if (!fs::exists(name)) {
        auto scene = scene::loadBuiltin(name);
        if (!scene) throw Error(scene.error().message);
        return std::move(*scene);
    }
    std::ifstream stream(name, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    auto scene = scene::loadGlb(std::as_bytes(std::span(bytes)), name);
    if (!scene) throw Error(name + ": " + scene.error().message);
    return std::move(*scene);
}

Subject subjectOf(const ReferenceOptions& options) {
    const fs::path path(options.scene);
    if (path.extension() == ".json") return {tracer::worldOfJson(options.scene), std::nullopt, path.stem().string()};
    scene::Scene scene = loadScene(options.scene);
    const auto key = static_cast<std::size_t>(render::keyLight(scene));
    const auto walls = options.thinWallsAbsent ? tracer::ThinWalls::Absent : tracer::ThinWalls::Receivers;
    const auto mirrors = options.mirrorsReceive ? tracer::Mirrors::Receivers : tracer::Mirrors::Casters;
    return {tracer::worldOf(scene, scene.lights[key], walls, mirrors), std::move(scene), path.stem().string()};
}

// The window that a JSON of tests/reference names.
tracer::Window windowOfJson(const std::string& file) {
    std::ifstream stream(file);
    const json window = json::parse(stream).at("window");
    const double width = window.at("width");
    const int cells = window.at("cells");
    return {{window.at("x0"), 0.0, window.at("z0")}, {width, 0, 0}, {0, 0, width}, cells, cells};
}

// Where the renderer's own map of the scene lies; it depends on the scene alone, so the smallest frame tells.
glm::dmat4 lightMatrix(const scene::Scene& scene) {
    const auto context = gl::Context::create({.gpu = "software"});
    gl::ShaderLibrary shaders;
    render::Pipeline pipeline(*context, shaders);
    render::Request request;
    request.scene = std::make_shared<const scene::Scene>(scene);
    request.camera = scene.cameras.front();
    request.target = render::Target::Spectral;
    request.sample = render::Sample::F32;
    request.transport.mapSize = 64;
    request.transport.photonGrid = 16;
    return glm::dmat4(pipeline.run(request).lightMatrix);
}

json describe(const tracer::Image& image, const std::string& file) {
    return {{"file", file}, {"shape", {image.channels, image.rows, image.columns}}, {"estimated_relative_L1", image.relativeL1}};
}

json describe(const tracer::Ledger& ledger) {
    return {{"on_casters", ledger.onCasters},         {"landed", ledger.landed},
            {"absorbed", ledger.absorbed},            {"mirrors", ledger.mirrors},
            {"first_reflected", ledger.firstReflected},
            {"below_threshold", ledger.belowThreshold}, {"interface_limit", ledger.interfaceLimit},
            {"escaped", ledger.escaped}};
}

class Output {
 public:
    Output(std::string folder, std::string stem) : folder_(std::move(folder)), stem_(std::move(stem)) {
        if (!folder_.empty()) fs::create_directories(folder_);
    }

    void add(const tracer::Image& image, const std::string& what) {
        if (image.channels == 0) return;
        std::printf("  %s:", what.c_str());
        for (const double error : image.relativeL1) std::printf(" %.5f", error);
        std::printf("  estimated relative L1\n");
        if (folder_.empty()) return;
        const std::string file = stem_ + "_" + what + ".npy";
        const auto length = [](int n) { return static_cast<std::size_t>(n); };
        npy::write((fs::path(folder_) / file).string(), {length(image.channels), length(image.rows), length(image.columns)}, image.values);
        images_.push_back(describe(image, file));
    }

    void finish(const ReferenceOptions& options, const tracer::Result& result) const {
        if (folder_.empty()) return;
        json ledgers = json::array();
        for (const tracer::Ledger& ledger : result.ledgers) ledgers.push_back(describe(ledger));
        const Settings& settings = options.settings;
        const json file{{"scene", options.scene},
                        {"units", "windows: irradiance for unit intensity (1/m^2); maps: concentration; ledgers: sr (m^2 for a directional light)"},
                        {"nm", settings.wavelengthsNm},
                        {"observer", options.observer},
                        {"continuous_samples", settings.continuousSamples},
                        {"photons", result.photons},
                        {"photons_on_casters", result.hits},
                        {"max_interfaces", settings.maxInterfaces},
                        {"min_weight", settings.minWeight},
                        {"first_reflection", settings.firstReflection},
                        {"seconds", result.seconds},
                        {"worst_closure", result.worstClosure},
                        {"hidden", result.hidden},
                        {"ledgers", ledgers},
                        {"continuous_ledger", describe(result.continuous)},
                        {"images", images_}};
        const fs::path path = fs::path(folder_) / (stem_ + ".json");
        std::ofstream(path) << file.dump(1) << '\n';
        std::printf("written: %s\n", path.c_str());
    }

 private:
    std::string folder_, stem_;
    json images_ = json::array();
};

// Against maps that lie beside a JSON, as far as they are of the same channels and cells.
void compare(const tracer::Image& image, const std::string& base, const char* what) {
    for (const char* ending : {".npy", ".npy.gz"}) {
        const std::string file = base + ending;
        if (image.channels == 0 || !fs::exists(file)) continue;
        const npy::Array other = npy::read(file);
        if (other.values.size() != image.values.size()) continue;
        const std::size_t cells = image.values.size() / static_cast<std::size_t>(image.channels);
        double mean = 0.0;
        std::printf("%s against %s\n", what, file.c_str());
        for (int channel = 0; channel < image.channels; ++channel) {
            const std::size_t first = static_cast<std::size_t>(channel) * cells;
            const auto d = tracer::difference(&image.values[first], &other.values[first], image.columns, image.rows);
            mean += d.relativeL1 / image.channels;
            std::printf("  channel %d: relative L1 %.5f, flux ratio %.6f, centroid %.4f cells\n", channel, d.relativeL1, d.fluxRatio, d.centroidCells);
        }
        std::printf("  mean relative L1 %.5f\n", mean);
        return;
    }
}

void run(ReferenceOptions options) {
    const Subject subject = subjectOf(options);
    Settings& settings = options.settings;
    settings.observer = options.observer == "cie" ? tracer::Observer::Cie1931 : tracer::Observer::Wyman2013;
    if (const auto& w = options.window; !w.empty()) {
        settings.windows.push_back({{w[0], w[1], w[2]}, {w[3], w[4], w[5]}, {w[6], w[7], w[8]}, options.cells, options.cells});
    } else if (!subject.scene) {
        settings.windows.push_back(windowOfJson(options.scene));
    }
    if (options.mapSize > 0) {
        if (!subject.scene) throw Error("--map needs a scene that the renderer can load: a built-in one or a .glb");
        settings.maps.push_back({lightMatrix(*subject.scene), options.mapSize});
    }

    const tracer::Progress progress = [](double done) {
        std::fprintf(stderr, "\r%3.0f%%", 100.0 * done);
    };
    const tracer::Result result = options.cache.empty() ? tracer::trace(subject.world, settings, progress)
                                                        : tracer::traceCached(options.cache, subject.world, settings, progress);
    std::fprintf(stderr, "\r    \r");
    std::printf("%s: %llu photons, %llu on casters, %.1f s%s, worst closure of a photon's energy %.1e\n", options.scene.c_str(),
                static_cast<unsigned long long>(result.photons), static_cast<unsigned long long>(result.hits), result.seconds,
                result.cached ? " (cached)" : "", result.worstClosure);
    Output output(options.out, subject.stem);
    for (const tracer::Collected& window : result.windows) output.add(window.bands, "window_bands"), output.add(window.xyz, "window_xyz");
    for (const tracer::Collected& map : result.maps) output.add(map.bands, "map_bands"), output.add(map.xyz, "map_xyz");
    output.finish(options, result);
    if (subject.scene || !options.window.empty()) return;
    const std::string base = (fs::path(options.scene).parent_path() / subject.stem).string();
    compare(result.windows.front().bands, base + "_mono7", "irradiance");
    compare(result.windows.front().xyz, base + "_xyz", "XYZ");
}

}  // namespace

void addReference(CLI::App& app) {
    const auto options = std::make_shared<ReferenceOptions>();
    Settings& settings = options->settings;
    CLI::App* command = app.add_subcommand("reference", "trace exactly, on the CPU; compare with maps that lie beside a .json");
    command->add_option("--scene", options->scene, "a built-in scene, a .glb, or a .json of tests/reference")->capture_default_str();
    command->add_option("--photons", settings.photons, "directions from the light")->check(CLI::Range(2u, 1u << 30))->capture_default_str();
    command->add_option("--nm", settings.wavelengthsNm, "exact wavelengths; 0 for none")->delimiter(',')->capture_default_str();
    command->add_option("--continuous", settings.continuousSamples, "wavelengths a photon of a continuous spectrum, to XYZ")
        ->check(CLI::Range(0, 4096))->capture_default_str();
    command->add_option("--observer", options->observer, "the CIE's table or the fit of Wyman 2013")
        ->check(CLI::IsMember({"cie", "wyman"}))->capture_default_str();
    command->add_option("--interfaces", settings.maxInterfaces, "of one path")->check(CLI::Range(1, 256))->capture_default_str();
    command->add_option("--min-weight", settings.minWeight, "branches below it end")->check(CLI::Range(0.0, 0.5))->capture_default_str();
    command->add_flag("--first-reflection", settings.firstReflection, "also what glass throws back that the light meets first");
    command->add_flag("--thin-walls-absent", options->thinWallsAbsent, "light passes thin walls; without it they are receivers");
    command->add_flag("--mirrors-receive", options->mirrorsReceive, "smooth metal only stops light, as in refined mode; without it, it throws light");
    command->add_option("--window", options->window, "corner and two edges: x,y,z,ux,uy,uz,vx,vy,vz in m")->delimiter(',')->expected(9);
    command->add_option("--cells", options->cells, "of the window, a side")->check(CLI::Range(1, 8192))->capture_default_str();
    command->add_option("--map", options->mapSize, "texels a side of the renderer's spectral map; 0: none")->check(CLI::Range(0, 4096));
    command->add_option("--threads", settings.threads, "same bits either way")->check(CLI::Range(1, 2))->capture_default_str();
    command->add_option("--cache", options->cache, "folder of earlier results");
    command->add_option("--out", options->out, "folder for .npy and .json");
    command->callback([options] {
        if (options->settings.wavelengthsNm == std::vector<double>{0.0}) options->settings.wavelengthsNm.clear();
        run(*options);
    });
}

}  // namespace caustream::bench
