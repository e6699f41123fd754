#include "client/shot/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "client/connection/convergence_text.h"

namespace caustream::shot {
namespace {

constexpr int kCells = 24;
constexpr const char* kClearLine = "\r\033[K";

}  // namespace

ProgressBar::ProgressBar() : terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
    if (drawn_) std::fputs(kClearLine, stderr);
}

void ProgressBar::show(const protocol::Convergence& convergence) {
    if (!terminal_) return;
    const double progress = std::clamp(convergence.progress, 0.0, 1.0);
    const auto full = static_cast<std::size_t>(progress * kCells);
    const std::string bar = std::string(full, '#') + std::string(kCells - full, '.');
    std::fprintf(stderr, "%s[%s] %3.0f%%  %s", kClearLine, bar.c_str(), 100.0 * progress,
                 connection::convergenceText(convergence).c_str());
    std::fflush(stderr);
    drawn_ = true;
}

}  // namespace caustream::shot
