// What the command line and the file behind --config say; flags win.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "log.h"
#include "protocol/patch.h"

namespace caustream {

struct Config {
    std::string bind = "127.0.0.1";
    int port = 9720;              // 0: any free one
    std::string token;            // asked for in hello; empty: none
    std::string gpu = "auto";     // or "list"
    bool requireHardware = false;
    std::string shaderDir;        // empty: the shaders in the program
    log::Level logLevel = log::Level::Info;
    int maxSessions = 8;
    int gpuMsPerS = 0;               // GPU time that one viewer gets in a second; 0: no limit
    std::size_t viewerBytes = 1u << 30;  // estimated, that one viewer may take
    std::size_t assetCacheBytes = 512u << 20;  // of scenes that no one shows
    std::string assetDir;            // where uploaded files are kept, for other servers too; empty: nowhere
    std::size_t assetDirBytes = 4096ull << 20;
    std::string recordDir;        // where viewers may have their sessions recorded; empty: nowhere
    std::size_t testFrameBytes = 0;  // frames are that many bytes of noise instead of pictures; 0: pictures
    int testFrameMs = 0;             // and take this long to draw
    std::string serverId;         // what ?srv= of the address names; empty: random

    std::string tlsCert, tlsKey;  // PEM files; both or neither
    std::vector<std::string> allowedOrigins;  // of pages besides the server's own, "https://host[:port]"
    int maxConnections = 256;     // sockets in all, HTTP's too
    int maxPerAddress = 64;       // of one address
    int drainS = 20;              // from SIGTERM to the end, at most
    int watchdogS = 30;           // a frame that takes longer ends the program

    // Faults on purpose, for tests; 0: never.
    int testHangAfterFrames = 0, testLoseGpuAfterFrames = 0;

    std::string planScene;        // print its plan instead of serving: a built-in scene's name or a GLB file
    std::vector<protocol::Setting> settings;  // of that scene's state document
};

// Nothing: --help was asked for and printed. Throws Error for options that make no sense.
std::optional<Config> parseCommandLine(int argc, const char* const* argv);

}  // namespace caustream
