// What caustream-shot was asked for on its command line.
#pragma once
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "client/connection/address.h"
#include "client/shot/line_job.h"
#include "protocol/patch.h"

namespace caustream::shot {

enum class FileKind { Png, Npy, Exr, Jpeg };

inline constexpr int kShotJpegQuality = 95;

struct Options {
    connection::Address address;
    std::string scene;  // empty: the server's own choice; otherwise a name or a .glb file
    std::vector<protocol::Setting> settings;
    std::string target = "composite";
    int width = 512, height = 512;
    int frames = 1;
    bool moving = false;    // stream while the light moves, instead of stills
    bool converge = false;  // stream until nothing is left to gain
    int timeoutS = 120;   // for each thing that is waited for
    std::string caFile;   // of --url https://...; empty: the system's
    std::string token;
    std::string out;        // a file; of a batch or a replay: a folder
    FileKind kind = FileKind::Png;

    std::string batch;                               // a file of lines to draw; empty: one shot
    std::vector<std::string> targets{"composite"};   // of lines that name none
    std::vector<Format> formats;                     // of a batch's files
    int connections = 1;
    bool force = false;     // draw what is there already, too

    std::string replay;     // a log to play; empty: none
    int every = 1;          // a picture after each so many inputs
    bool realTime = false;  // wait as long between inputs as there was
};

struct ParseEnd {  // nothing to run: help was asked for, or the arguments are wrong
    int exitCode = 0;
    std::string text;
};
tl::expected<Options, ParseEnd> parseOptions(int argc, const char* const* argv);

}  // namespace caustream::shot
