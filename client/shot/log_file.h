// A log as a server wrote it (server/session/recorder.h): what was asked for, in order.
#pragma once
#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "protocol/state.h"

namespace caustream::shot {

struct LogStep {
    enum class Kind { Update, Input, Request };
    Kind kind = Kind::Update;
    int number = 0;              // of its line, from 1
    std::uint64_t atUs = 0;      // since the log began
    protocol::Json patch;        // Update, Input
    std::uint32_t seq = 0;       // Input: its number then
    std::uint32_t id = 0;        // Request: its number then
    bool still = false, converge = false;        // Request
    std::optional<std::string> mapHash;          // Request: of its answer, where it came
    std::optional<std::uint32_t> photons;        // in that map
};

struct Log {
    protocol::Json state;        // the document that it starts with
    std::string build, gpu;      // that it was recorded with
    std::vector<LogStep> steps;
    bool ended = false;          // it has its last line
};

// The error is a sentence that names the line.
tl::expected<Log, std::string> readLog(std::istream& in);

}  // namespace caustream::shot
