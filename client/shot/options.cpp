#include "client/shot/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <sstream>

namespace caustream::shot {
namespace {

constexpr const char* kExamples = R"(Examples:
  caustream-shot --url http://127.0.0.1:9720 --scene gem --out gem.png
  caustream-shot --url http://127.0.0.1:9720 --scene glass.glb --width 1024 --height 768 --out glass.jpg
  caustream-shot --url http://127.0.0.1:9720 --scene prism --target spectral --set transport.wavelengths=21 --out map.npy
  caustream-shot --url http://127.0.0.1:9720 --scene sphere --set 'lights.key.position=[1,2,0.5]' \
                 --set 'camera.exposure=["ev",9]' --out moved.png
  caustream-shot --url http://127.0.0.1:9720 --scene gem --moving --frames 60 --out last.jpg
  caustream-shot --url http://127.0.0.1:9720 --scene gem --converge --set transport.target_error=0.005 --out exact.png
  caustream-shot --url http://127.0.0.1:9720 --scene gem --target depth --out depth.exr
  caustream-shot --url http://127.0.0.1:9720 --batch poses.jsonl --target composite,depth,caster_mask --out set
  caustream-shot --url http://127.0.0.1:9720 --replay logs/0123abcd-1.jsonl --out played

The ending of FILE chooses the format: .png (8 bits, fetched lossless), .npy and .exr (float32, linear: the spectral map or
the picture before exposure's curve; of the targets depth, normals and caster_mask their numbers), .jpg. A # in FILE becomes the frame's number; without it the last frame is kept.
FILE.json tells the rest: stream.info, the frame's header, statistics, the map's hash.

--set takes any path of the state document, dotted or as a JSON Pointer (/lights/key.001/position), and a value in JSON:
  lights.NAME.position=[x,y,z]  lights.NAME.direction=[x,y,z]  lights.NAME.half_angle_deg=20
  lights.NAME.intensity=["cd",100]  camera.eye=[x,y,z]  camera.target=[x,y,z]  camera.fov_y_deg=40
  materials.NAME.dispersion=["cauchy",1.458,0.00354]  transport.map_size=1024  transport.photon_grid=512
  transport.wavelengths="continuous" (the default) or 1 to 64 exact ones  transport.gap_fill=true
  transport.mode=auto (the default), traced, refined or thesis  transport.bounces=8 (0 to 32, for what is traced)
  transport.exact_receivers=true  transport.target_error=0.01

One still is one frame: quick, and of a traced scene as good as one frame's photons. --converge waits until the server has
traced enough of them, that is until the map's estimated error is under transport.target_error (1% unless it is set), and
fetches the picture then: seconds on a GPU, minutes without one. Half the error takes two to four times as long. What is not
traced (mode "refined" or "thesis", or no light on any glass) has nothing to converge and comes at once.

--batch draws a picture for each line of FILE, a JSON object each, into the folder --out:
  {"name": "left", "patch": {"lights": {"key": {"position": [-1, 2, 0.5]}}}}
  {"name": "prism", "patch": {"scene": ["builtin", "prism"]}, "targets": ["composite", "bands", "depth"], "converge": true}
patch changes what --scene, --width, --height and --set show, as an update of the protocol would; each line starts from there.
NAME.TARGET.png, .npy and .exr hold the pictures, NAME.json what is known of them, index.jsonl lists all. The same command
again draws what is missing or was asked for otherwise. It exits with 0, with 2 where lines failed (it says which, and why),
with 1 where it could not run. docs/batch.md has it all, and how to make such a file.

--replay plays a log that a server wrote (its --record-dir), and tells in report.jsonl where a map is another than then.

scripts/run.sh --shot FILE starts a server, takes the picture and stops the server.)";

tl::expected<FileKind, std::string> kindOf(const std::string& file) {
    std::string ending = std::filesystem::path(file).extension();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending == ".png") return FileKind::Png;
    if (ending == ".npy") return FileKind::Npy;
    if (ending == ".exr") return FileKind::Exr;
    if (ending == ".jpg" || ending == ".jpeg") return FileKind::Jpeg;
    return tl::make_unexpected("--out " + file + ": the ending chooses the format; use .png, .npy, .exr or .jpg");
}

}  // namespace

tl::expected<Options, ParseEnd> parseOptions(int argc, const char* const* argv) {
    const auto wrong = [](const std::string& why) {
        return tl::make_unexpected(ParseEnd{1, "caustream-shot: " + why + "; caustream-shot --help shows how\n"});
    };
    Options options;
    std::string url = connection::kDefaultUrl;
    std::vector<std::string> settings;
    CLI::App app("Fetches frames from a caustream server and writes them to a file.", "caustream-shot");
    app.footer(kExamples);
    app.add_option("--url", url, "the server, as its ready line says")->capture_default_str();
    app.add_option("--scene", options.scene, "a scene of the server, or a GLB file to send it");
    app.add_option("--set", settings, "PATH=VALUE: sets a value of the state document; repeatable")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->allow_extra_args(false);
    app.add_option("--target", options.target, "composite, spectral, depth, normals, caster_mask or the name of a pass; of a batch, several with commas, and bands")
        ->capture_default_str();
    app.add_option("--width", options.width, "of the picture")->check(CLI::Range(16, 4096))->capture_default_str();
    app.add_option("--height", options.height, "of the picture")->check(CLI::Range(16, 4096))->capture_default_str();
    app.add_option("--frames", options.frames, "how many")->check(CLI::Range(1, 100000))->capture_default_str();
    app.add_flag("--moving", options.moving, "stream while the light circles, instead of stills: times the whole way");
    app.add_flag("--converge", options.converge, "wait until the picture has converged to transport.target_error; shows how far it is");
    app.add_option("--timeout", options.timeoutS, "seconds to wait for the server, each time")
        ->check(CLI::Range(1, 3600))
        ->capture_default_str();
    app.add_option("--ca", options.caFile, "PEM file: what an https server's certificate is checked against, instead of the system's")->check(CLI::ExistingFile);
    app.add_option("--token", options.token, "the server's, where it asks for one");
    app.add_option("--out", options.out, "the file: .png, .npy, .exr or .jpg; of --batch and --replay a folder")->required();
    std::string formats = "png,exr";
    auto* batch = app.add_option("--batch", options.batch, "a file of lines to draw, each into files of its own")->check(CLI::ExistingFile);
    app.add_option("--format", formats, "of a batch's files: png, npy, exr, parted by commas")->capture_default_str()->needs(batch);
    app.add_option("--connections", options.connections, "that a batch goes over")->check(CLI::Range(1, 8))->capture_default_str()->needs(batch);
    app.add_flag("--force", options.force, "draw a batch's lines whose files are there, too")->needs(batch);
    auto* replay = app.add_option("--replay", options.replay, "a log to play, with a still after each input")->check(CLI::ExistingFile)->excludes(batch);
    bool atInputs = true;
    auto* every = app.add_option("--every", options.every, "a still after each so many inputs of the log")->check(CLI::Range(1, 1000000))->needs(replay);
    app.add_flag("--at-inputs", atInputs, "a still after each input of the log: the default")->needs(replay)->excludes(every);
    app.add_flag("--real-time", options.realTime, "with the pauses that the log had, instead of as fast as frames come")->needs(replay);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        return tl::make_unexpected(ParseEnd{0, app.help()});
    } catch (const CLI::ParseError& error) {
        return wrong(error.what());
    }

    if (options.converge && options.moving) return wrong("--converge waits for a scene at rest, --moving moves its light: choose one");
    auto address = connection::parseAddress(url);
    if (!address) return wrong(address.error());
    options.address = std::move(*address);
    auto parsed = parseFormats(formats);
    if (!parsed) return wrong(parsed.error());
    options.formats = std::move(*parsed);
    if (!options.batch.empty() || !options.replay.empty()) {
        if (options.moving || options.frames > 1) return wrong("--moving and --frames are for single shots");
        options.targets.clear();
        std::istringstream targets(options.target);
        for (std::string target; std::getline(targets, target, ',');) options.targets.push_back(target);
        options.target = "composite";
    } else {
        auto kind = kindOf(options.out);
        if (!kind) return wrong(kind.error());
        options.kind = *kind;
    }
    for (const auto& text : settings) {
        auto setting = protocol::parseSetting(text);
        if (!setting) return wrong(setting.error());
        options.settings.push_back(std::move(*setting));
    }
    return options;
}

}  // namespace caustream::shot
