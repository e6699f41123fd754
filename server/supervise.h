// What main does while the server serves: waits for a signal, and watches that the other threads get on.
#pragma once
#include <csignal>

#include "config.h"
#include "service.h"

namespace caustream {

inline constexpr int kExitFailed = 70;  // EX_SOFTWARE of sysexits.h: a supervisor is to start the server again

// Until SIGTERM or SIGINT, which `signals` holds and all threads block: returns then, after the viewers have left. A second
// one ends the process at once, and so does, with kExitFailed, a thread that stands still or a GPU that is lost.
void supervise(Service& service, const sigset_t& signals, const Config& config);

}  // namespace caustream
