// Everything between the command line and the files.
#pragma once
#include <string>
#include <tl/expected.hpp>

#include "client/shot/options.h"

namespace caustream::shot {

// What was written, in a line; or what went wrong, where, and what to try.
tl::expected<std::string, std::string> shoot(const Options& options);

}  // namespace caustream::shot
