// A line of a batch, ready to be drawn, and what is drawn of it.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "client/connection/events.h"
#include "client/shot/batch_line.h"

namespace caustream::shot {

enum class Format { Png, Npy, Exr };
inline constexpr Format kFormats[] = {Format::Png, Format::Npy, Format::Exr};
const char* nameOf(Format format);  // also a file's ending

// "png,exr" in any order. The error is a sentence.
tl::expected<std::vector<Format>, std::string> parseFormats(const std::string& text);

// Whether `format` can hold what `target` shows without loss: PNG has 8 bits, and passes other than these are pictures.
bool holds(Format format, const std::string& target);

struct LineJob {
    int number = 0;             // of its line in the batch, from 1
    std::string name;
    protocol::Json patch;       // as the line has it
    protocol::Json document;    // to show; its scene may be ["file", path]
    std::vector<std::string> targets;
    bool converge = false;
    std::string key;            // hash of all that its files depend on, but for the server
};

struct Shown {
    connection::Frame frame;
    std::optional<protocol::Stats> stats;
};

struct Drawn {  // of one target
    std::string target;
    std::optional<Shown> bytes, floats;
    const Shown& any() const { return floats ? *floats : *bytes; }
};

}  // namespace caustream::shot
