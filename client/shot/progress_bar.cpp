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
    clear();
}

void ProgressBar::clear() {
    if (drawn_) std::fputs(kClearLine, stderr);
    drawn_ = false;
}

void ProgressBar::show(const protocol::Convergence& convergence) {
    show(convergence.progress, connection::convergenceText(convergence));
}

void ProgressBar::show(double share, const std::string& text) {
    if (!terminal_) return;
    const double progress = std::clamp(share, 0.0, 1.0);
    const auto full = static_cast<std::size_t>(progress * kCells);
    const std::string bar = std::string(full, '#') + std::string(kCells - full, '.');
    std::fprintf(stderr, "%s[%s] %3.0f%%  %s", kClearLine, bar.c_str(), 100.0 * progress, text.c_str());
    std::fflush(stderr);
    drawn_ = true;
}

}  // namespace caustream::shot
