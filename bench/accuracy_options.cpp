#include "bench/accuracy_options.h"

#include <cstdio>
#include <cstdlib>

#include "bench/statistics.h"

namespace caustream::bench {

std::string defaultCacheFolder() {
    const char* cache = std::getenv("XDG_CACHE_HOME");
    if (cache && *cache) return std::string(cache) + "/caustream/reference";
    const char* home = std::getenv("HOME");
    return std::string(home && *home ? home : ".") + "/.cache/caustream/reference";
}

void addAccuracyOptions(CLI::App& command, AccuracyOptions& options) {
    StudySettings& study = options.study;
    study.truth.cacheFolder = defaultCacheFolder();
    command.add_option("--gpu", study.gpu, "auto, software, an index or part of a name")->capture_default_str();
    command.add_option("--rounds", study.rounds, "turns that each configuration's timing gets")->check(CLI::Range(1, 1000))->capture_default_str();
    command.add_option("--frames", study.frames, "frames counted in a turn")->check(CLI::Range(1, 1000))->capture_default_str();
    command.add_option("--size", study.truth.pictureSize, "pixels a side")->check(CLI::Range(64, 2048))->capture_default_str();
    command.add_option("--cells", study.truth.cells, "cells a side that maps are compared on (not the reference scenes': 256)")
        ->check(CLI::Range(16, 1024))->capture_default_str();
    command.add_option("--photons", study.truth.photons, "photons of a reference")->check(CLI::Range(1024, 1 << 30))->capture_default_str();
    command.add_option("--cache", study.truth.cacheFolder, "where references are kept")->capture_default_str();
    command.add_option("--out", options.out, "folder for results, tables and plots")->capture_default_str();
    command.add_flag("--quick", options.quick, "fewer configurations, turns and photons: to try");
    command.add_flag("--fresh", options.fresh, "measure again what the folder's results.jsonl holds already");
}

void begin(AccuracyOptions& options, const Renderer& renderer) {
    if (options.quick) {
        options.study.rounds = std::min(options.study.rounds, 2);
        options.study.truth.photons = std::min<std::uint64_t>(options.study.truth.photons, 1u << 18);
    }
    const StudySettings& study = options.study;
    std::printf("%s; pictures %d x %d; medians of %d frames in %d turns; calibration: fixed loop %.1f ms\n", renderer.context().renderer().c_str(),
                study.truth.pictureSize, study.truth.pictureSize, study.rounds * study.frames, study.rounds, calibrationMs());
    std::fflush(stdout);
}

}  // namespace caustream::bench
