// From the command line's options to a session that shows what they ask for.
#pragma once
#include "client/shot/options.h"
#include "client/shot/session.h"

namespace caustream::shot {

// How to reach the server that the options name.
connection::Options connectionTo(const Options& options);

bool isFile(const std::string& scene);
tl::expected<std::vector<std::uint8_t>, Failure> readFile(const std::string& name);

// The scene, the stream and --set.
Session::Done configure(Session& session, const Options& options);

}  // namespace caustream::shot
