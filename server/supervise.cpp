#include "supervise.h"

#include <unistd.h>

#include <chrono>
#include <string>
#include <thread>

#include "log.h"
#include "notify.h"

namespace caustream {
namespace {

using namespace std::chrono_literals;

constexpr auto kRound = 250ms;
constexpr auto kGrace = 2s;       // for the viewers to hear that the server ends
constexpr auto kLastFrame = 2s;   // for the frame that is being drawn when all else has ended
constexpr int kShutdownS = 2;     // a person waits at the terminal

// The signal that came within a round; 0: none.
int nextSignal(const sigset_t& signals) {
    const timespec round{.tv_sec = 0, .tv_nsec = std::chrono::nanoseconds(kRound).count()};
    const int signal = sigtimedwait(&signals, nullptr, &round);
    return signal > 0 ? signal : 0;
}

// Nothing has to be put away: what a stuck driver keeps from ending ends here.
[[noreturn]] void endAtOnce(int code) {
    std::fflush(nullptr);
    _exit(code);
}

void drain(Service& service, const sigset_t& signals, bool shutdown, int seconds) {
    notifySupervisor("STOPPING=1\nSTATUS=draining");
    service.drain(shutdown ? protocol::Goaway::Reason::Shutdown : protocol::Goaway::Reason::Drain, shutdown ? kShutdownS : seconds);
    while (!service.ended()) {
        if (nextSignal(signals) != 0) {
            log::warning("stopping").with("message", "a second signal: at once");
            endAtOnce(0);
        }
    }
    for (const auto last = std::chrono::steady_clock::now() + kLastFrame; service.drawing(); std::this_thread::sleep_for(10ms)) {
        if (std::chrono::steady_clock::now() > last) {
            endAtOnce(0);
        }
    }
}

}  // namespace

void supervise(Service& service, const sigset_t& signals, const Config& config) {
    notifySupervisor("READY=1\nSTATUS=serving");
    while (true) {
        if (const int signal = nextSignal(signals)) {
            log::info("stopping").with("signal", signal);
            drain(service, signals, signal == SIGINT, config.drainS);
            return;
        }
        if (const auto why = service.failure()) {
            service.fail(*why);
            notifySupervisor("STATUS=failed: " + *why);
            std::this_thread::sleep_for(kGrace);
            endAtOnce(kExitFailed);
        }
        notifySupervisor("WATCHDOG=1");
    }
}

}  // namespace caustream
