#include "bench/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace caustream::bench {

Progress::Progress(std::string what)
    : what_(std::move(what)), terminal_(isatty(STDERR_FILENO) != 0), start_(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
    if (terminal_) std::fputs("\r\033[K", stderr);
}

void Progress::at(double share, const std::string& now) {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    share = std::clamp(share, 0.0, 1.0);
    if (!terminal_) {
        const int tenth = static_cast<int>(10.0 * share);
        if (tenth == shown_) return;
        shown_ = tenth;
        std::fprintf(stderr, "%s: %d0%%, %.0f s\n", what_.c_str(), tenth, seconds);
        return;
    }
    constexpr int kWidth = 24;
    const int full = static_cast<int>(share * kWidth);
    std::fprintf(stderr, "\r\033[K%s [%s%s] %3.0f%% %.0f s", what_.c_str(), std::string(static_cast<std::size_t>(full), '#').c_str(),
                 std::string(static_cast<std::size_t>(kWidth - full), '.').c_str(), 100.0 * share, seconds);
    if (share > 0.02) std::fprintf(stderr, ", %.0f s to go", seconds * (1.0 - share) / share);
    if (!now.empty()) std::fprintf(stderr, "  %.60s", now.c_str());
    std::fflush(stderr);
}

}  // namespace caustream::bench
