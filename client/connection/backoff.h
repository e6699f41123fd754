// How long to wait before a server is tried again.
#pragma once

namespace caustream::connection {

inline constexpr int kFirstWaitMs = 250, kLongestWaitMs = 8000;

// Doubles from the first wait to the longest. Every wait is a random part of its bound, at least half of it: the many
// viewers of a server that restarts do not come back at once.
class Backoff {
 public:
    // `random`: 0..1. What it returns is milliseconds.
    int next(double random);
    // A server took us in: the next loss begins anew.
    void reset() { boundMs_ = kFirstWaitMs; }

 private:
    int boundMs_ = kFirstWaitMs;
};

// What a goaway asks for: its `reconnect_ms` and a random part, 0..1, of its `jitter_ms`; at most a minute.
int comeBackMs(unsigned reconnectMs, unsigned jitterMs, double random);

}  // namespace caustream::connection
