#include "client/view/options.h"

#include <CLI/CLI.hpp>
#include <filesystem>

namespace caustream::view {
namespace {

constexpr const char* kHelp = R"(Examples:
  caustream-view
  caustream-view --url http://192.168.1.20:9720 --scene prism
  caustream-view glass.glb
  caustream-view --url https://render.example.org --token SECRET
  caustream-view --follow ID
  caustream-view --scene gem --set transport.mode=refined --set 'camera.exposure=["ev",9]'

Mouse: left drag orbits, right or middle drag pans, the wheel zooms; Shift + left drag moves the light.
Keys:  S saves the picture as PNG, L swaps what the left button drags, R resets the camera, Tab hides the panel, Esc quits.
A GLB file dropped on the window is sent to the server and shown.

scripts/run.sh starts a server and this window together.)";

}  // namespace

tl::expected<Options, ParseEnd> parseOptions(int argc, const char* const* argv) {
    const auto wrong = [](const std::string& why) {
        return tl::make_unexpected(ParseEnd{1, "caustream-view: " + why + "; caustream-view --help shows how\n"});
    };
    Options options;
    std::string url = connection::kDefaultUrl;
    std::vector<std::string> settings;
    CLI::App app("A window on a caustream server.", "caustream-view");
    app.footer(kHelp);
    app.add_option("FILE", options.file, "a GLB file to send and show");
    app.add_option("--url", url, "the server, as its ready line says")->capture_default_str();
    app.add_option("--scene", options.scene, "a scene of the server");
    app.add_option("--set", settings, "PATH=VALUE: sets a value of the state document, as caustream-shot's; repeatable")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->allow_extra_args(false);
    app.add_option("--save-folder", options.saveFolder, "where S puts its pictures")->capture_default_str();
    app.add_option("--width", options.width, "of the window")->check(CLI::Range(480, 7680))->capture_default_str();
    app.add_option("--height", options.height, "of the window")->check(CLI::Range(320, 4320))->capture_default_str();
    app.add_option("--token", options.token, "the server's, where it asks for one");
    app.add_option("--follow", options.follow, "shows another viewer's scene and light, by the session id that its panel copies");
    app.add_option("--ca", options.caFile, "PEM file: what an https server's certificate is checked against, instead of the system's")
        ->check(CLI::ExistingFile);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        return tl::make_unexpected(ParseEnd{0, app.help()});
    } catch (const CLI::ParseError& error) {
        return wrong(error.what());
    }
    auto address = connection::parseAddress(url);
    if (!address) return wrong(address.error());
    options.address = std::move(*address);
    if (!options.follow.empty() && (!options.file.empty() || !options.scene.empty()))
        return wrong("--follow shows another viewer's scene; leave the scene or file out");
    if (!options.file.empty() && !std::filesystem::is_regular_file(options.file))
        return wrong("cannot read " + options.file);
    for (const auto& text : settings) {
        auto setting = protocol::parseSetting(text);
        if (!setting) return wrong(setting.error());
        options.settings.push_back(std::move(*setting));
    }
    return options;
}

}  // namespace caustream::view
