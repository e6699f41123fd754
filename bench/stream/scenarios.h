// The scenarios of `caustream-bench stream`: each starts a server of its own, plays, and reports. docs/streaming.md defines
// the figures. All are bounded in time, stay on loopback and end by themselves.
#pragma once
#include <cstdint>
#include <string>

#include "bench/stream/report.h"
#include "client/connection/address.h"

namespace caustream::bench {

struct ScenarioOptions {
    std::string server;          // the program
    std::string gpu = "auto";    // as caustream-server's --gpu
    double minutes = 0;          // of the scenarios that go on; 0: each one's own short time
    int frames = 60;             // counted, where frames are
    int count = 10'000;          // of malformed messages and files
    std::string corpus;          // a folder whose files are sent, too; empty: none
    std::string svg;             // where ladder draws; empty: nowhere
};

Report steady(const ScenarioOptions& options);      // a slow reader, and a slow reader far away
Report ladder(const ScenarioOptions& options);      // a link that changes
Report neighbours(const ScenarioOptions& options);  // three that behave badly, five that do not
Report latency(const ScenarioOptions& options);     // input to picture on an idle server
Report shared(const ScenarioOptions& options);      // five viewers of one lit scene
Report soak(const ScenarioOptions& options);        // eight that come, go, upload and move
Report malformed(const ScenarioOptions& options);   // what a stranger sends, and a viewer beside it

// What the socket adds to rendering, with a server that runs.
Report added(const connection::Address& address, const std::string& scene, int frames);

}  // namespace caustream::bench
