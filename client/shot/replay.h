// caustream-shot --replay: a session's log, played to a server.
#pragma once
#include "client/shot/options.h"

namespace caustream::shot {

// Pictures and report.jsonl into the folder; says on standard error what went wrong, and on standard output what came of it.
// The exit code: 0, 2 where a map is not the one that the log noted, 1 it could not run, 130 it was stopped.
int runReplay(const Options& options);

}  // namespace caustream::shot
