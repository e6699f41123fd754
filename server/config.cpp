#include "config.h"

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>

#include "error.h"

namespace caustream {
namespace {

constexpr const char* kAbout = R"(Renders spectral caustics and streams them to viewers over one WebSocket.

  caustream-server                       serve on http://127.0.0.1:9720/ ; open it in a browser
  caustream-server --port 0              on any free port; the last line of output names it
  caustream-server --gpu list            show the GPUs there are
  caustream-server --bind 0.0.0.0 --token-file secret.txt   let other machines in, with a token
  caustream-server --config caustream.toml      the same options from a file; flags win over it
  caustream-server --plan gem            say which passes this scene's frames run, and why; serve nothing

Prints one line "ready http://..." on standard output once frames can be asked for; logs go to standard error.
SIGTERM lets the viewers leave for another server, then ends; Ctrl-C ends at once.)";

std::string readToken(const std::string& path) {
    std::ifstream file(path);
    std::string token;
    if (!file || !std::getline(file, token)) {
        throw Error("token file; cannot read " + path + "; check the path, its first line is the token");
    }
    while (!token.empty() && (token.back() == '\r' || token.back() == ' ')) {
        token.pop_back();
    }
    if (token.size() < 16) {
        throw Error("token file; the token in " + path + " is shorter than 16 characters; try: openssl rand -hex 32 > " + path);
    }
    return token;
}

bool loopback(const Config& config) { return config.bind.starts_with("127."); }

void addNetworkOptions(CLI::App& app, Config& config) {
    app.add_option("--tls-cert", config.tlsCert, "PEM file with the certificate and its chain: https and wss")
        ->check(CLI::ExistingFile);
    app.add_option("--tls-key", config.tlsKey, "PEM file with the certificate's private key")->check(CLI::ExistingFile);
    app.add_option("--allow-origin", config.allowedOrigins,
                   "https://HOST[:PORT] of a page that may connect besides the server's own; repeatable")
        ->expected(1, -1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->allow_extra_args(false);
    app.add_option("--max-connections", config.maxConnections, "sockets at once, those of plain HTTP too")
        ->check(CLI::Range(8, 10'000))->capture_default_str();
    app.add_option("--max-per-address", config.maxPerAddress, "sockets of one address; raise it behind a proxy")
        ->check(CLI::Range(1, 10'000))->capture_default_str();
}

void addOperationOptions(CLI::App& app, Config& config) {
    app.add_option("--server-id", config.serverId, "this server's name in ?srv= and in welcome; random without")
        ->check([](const std::string& id) {
            const bool good = !id.empty() && id.size() <= 64 &&
                              id.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.") == std::string::npos;
            return good ? "" : "a server id has 1 to 64 letters, digits, dots, dashes and underscores";
        });
    app.add_option("--drain-s", config.drainS, "seconds that viewers get to leave after SIGTERM")
        ->check(CLI::Range(1, 3600))->capture_default_str();
    app.add_option("--watchdog-s", config.watchdogS, "seconds that one frame may take before the program gives up")
        ->check(CLI::Range(1, 3600))->capture_default_str();
    app.add_option("--test-hang-after-frames", config.testHangAfterFrames)->group("")->configurable(false);
    app.add_option("--test-lose-gpu-after-frames", config.testLoseGpuAfterFrames)->group("")->configurable(false);
}

void checkNetworkOptions(const Config& config) {
    if (!loopback(config) && config.token.empty()) {
        throw Error("command line; --bind " + config.bind + " lets other machines in; give --token-file, or stay on 127.0.0.1");
    }
    if (config.tlsCert.empty() != config.tlsKey.empty()) {
        throw Error("command line; --tls-cert and --tls-key go together; give both, or neither for plain http");
    }
    for (const std::string& origin : config.allowedOrigins) {
        const std::size_t scheme = origin.find("://");
        if (scheme == std::string::npos || origin.find('/', scheme + 3) != std::string::npos || origin.size() == scheme + 3) {
            throw Error("command line; --allow-origin " + origin + "; an origin is scheme, host and port, as https://example.org");
        }
    }
}

// CLI11's words for the same, which say neither where nor what to try.
std::string sentence(const CLI::ParseError& problem, const CLI::Option& file) {
    if (dynamic_cast<const CLI::ConfigError*>(&problem)) {
        std::string text = problem.what();
        if (const std::size_t key = text.find("parse "); key != std::string::npos) {
            text = "it has no option \"" + text.substr(key + 6) + "\"";
        }
        const std::string path = file.count() > 0 ? file.as<std::string>() : "";
        return "config file " + path + "; " + text + "; deploy/caustream.toml names all there are, --help explains them";
    }
    return std::string("command line; ") + problem.what() + "; try --help";
}

}  // namespace

std::optional<Config> parseCommandLine(int argc, const char* const* argv) {
    Config config;
    std::string level = "info", tokenFile;
    std::size_t viewerMb = 1024, assetCacheMb = 512, assetDirMb = 4096;
    CLI::App app(kAbout, "caustream-server");
    const CLI::Option& file = *app.set_config("--config", "", "read options from this TOML file");
    app.allow_config_extras(CLI::config_extras_mode::error);
    app.add_option("--port", config.port, "TCP port; 0 takes any free one")->check(CLI::Range(0, 65535))->capture_default_str();
    app.add_option("--bind", config.bind, "IPv4 address to listen on; another than loopback needs --token-file")->capture_default_str();
    app.add_option("--token-file", tokenFile, "file whose first line viewers must present");
    app.add_option("--gpu", config.gpu, "auto, software, list, an index of the list, or part of a name")->capture_default_str();
    app.add_flag("--require-hardware", config.requireHardware, "fail rather than render in software");
    app.add_option("--shader-dir", config.shaderDir, "read shaders from this folder, and again when they change")
        ->check(CLI::ExistingDirectory);
    app.add_option("--log-level", level, "debug, info, warning or error")->capture_default_str();
    app.add_option("--max-sessions", config.maxSessions, "viewers at once")->check(CLI::Range(1, 64))->capture_default_str();
    app.add_option("--gpu-ms-per-s", config.gpuMsPerS, "of each second, the most GPU time that one viewer gets; 0: no limit")
        ->check(CLI::Range(0, 1000));
    app.add_option("--viewer-mb", viewerMb, "memory that one viewer's scene, maps and pictures may take, estimated")
        ->check(CLI::Range(16, 1 << 20))
        ->capture_default_str();
    app.add_option("--asset-cache-mb", assetCacheMb, "memory for scenes that no one shows any more")
        ->check(CLI::Range(0, 1 << 20))
        ->capture_default_str();
    app.add_option("--asset-dir", config.assetDir, "folder to keep uploaded files in; servers that share it have each other's");
    app.add_option("--asset-dir-mb", assetDirMb, "what that folder may hold; the oldest files go")
        ->check(CLI::Range(64, 1 << 24))
        ->capture_default_str();
    app.add_option("--test-frame-bytes", config.testFrameBytes, "send noise of so many bytes a frame instead of pictures: to measure links")
        ->check(CLI::Range(0, 64 << 20));
    app.add_option("--test-frame-ms", config.testFrameMs, "what drawing one of those takes")->check(CLI::Range(0, 10000));
    app.add_option("--record-dir", config.recordDir, "folder for the logs of viewers that ask to be recorded; without it none is")
        ->check(CLI::ExistingDirectory);
    addNetworkOptions(app, config);
    addOperationOptions(app, config);
    app.add_option("--plan", config.planScene, "a scene or a GLB file: print what its frames run, leave out, and why")
        ->configurable(false);
    std::vector<std::string> settings;
    app.add_option("--set", settings, "with --plan: PATH=VALUE, a value of the state document; repeatable")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->allow_extra_args(false)
        ->configurable(false);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        std::cout << app.help();
        return std::nullopt;
    } catch (const CLI::ParseError& problem) {
        throw Error(sentence(problem, file));
    }
    config.viewerBytes = viewerMb << 20;
    config.assetCacheBytes = assetCacheMb << 20;
    config.assetDirBytes = assetDirMb << 20;
    if (const auto known = log::levelFromName(level)) {
        config.logLevel = *known;
    } else {
        throw Error("command line; --log-level " + level + "; try debug, info, warning or error");
    }
    if (!settings.empty() && config.planScene.empty()) {
        throw Error("command line; --set says nothing without --plan; viewers set their own document");
    }
    for (const std::string& text : settings) {
        auto setting = protocol::parseSetting(text);
        if (!setting) {
            throw Error("command line; " + setting.error());
        }
        config.settings.push_back(std::move(*setting));
    }
    if (!tokenFile.empty()) {
        config.token = readToken(tokenFile);
    }
    checkNetworkOptions(config);
    return config;
}

}  // namespace caustream
