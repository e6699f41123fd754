// Options that the commands about accuracy share.
#pragma once
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "bench/accuracy/study.h"

namespace caustream::bench {

struct AccuracyOptions {
    StudySettings study;
    std::string out = "accuracy-results";
    bool quick = false, fresh = false;
};

// --gpu, --rounds, --frames, --size, --cells, --photons, --cache, --out, --quick, --fresh.
void addAccuracyOptions(CLI::App& command, AccuracyOptions& options);

// Settles what --quick leaves open; prints the machine, the settings and the calibration loop.
void begin(AccuracyOptions& options, const Renderer& renderer);

// Where references are kept unless told otherwise: $XDG_CACHE_HOME/caustream/reference, or below $HOME/.cache.
std::string defaultCacheFolder();

}  // namespace caustream::bench
