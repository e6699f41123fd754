// What caustream-view was asked for on its command line.
#pragma once
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "client/connection/address.h"
#include "protocol/patch.h"

namespace caustream::view {

struct Options {
    connection::Address address;
    std::string file;   // a GLB to show; empty: a scene of the server
    std::string scene;  // empty: the server's own choice
    std::vector<protocol::Setting> settings;  // of the first scene
    std::string token;
    std::string caFile;  // empty: the system's authorities
    std::string follow;  // a view id; empty: a scene of our own
    std::string saveFolder = ".";
    int width = 1280, height = 800;  // of the window
};

struct ParseEnd {  // nothing to run: help was asked for, or the arguments are wrong
    int exitCode = 0;
    std::string text;
};
tl::expected<Options, ParseEnd> parseOptions(int argc, const char* const* argv);

}  // namespace caustream::view
