// What the server counts of its viewers for /metrics. Numbers belong to the network thread; any thread may feed a histogram.
#pragma once
#include <prometheus/histogram.h>

#include <cstdint>
#include <map>

#include "protocol/errors.h"

namespace caustream {

struct Counters {
    std::map<protocol::ErrorCode, std::uint64_t> errors;  // that viewers were answered with
    std::uint64_t texts = 0, binaries = 0, receivedBytes = 0;
    std::uint64_t uploads = 0;  // files that became scenes

    // Seconds. From a change to the acknowledgement of a picture that shows it; a frame's drawing, a picture's encoding; how
    // late the network thread came to its quarterly round.
    prometheus::Histogram frameAge{{.01, .02, .035, .05, .075, .1, .15, .25, .5, 1, 2.5, 10}};
    prometheus::Histogram render{{.002, .005, .01, .02, .035, .05, .1, .25, .5, 1, 5, 20}};
    prometheus::Histogram encode{{.0005, .001, .002, .005, .01, .02, .05, .1, .25, 1}};
    prometheus::Histogram loopLag{{.001, .005, .01, .025, .05, .1, .5, 1, 5}};
};

}  // namespace caustream
