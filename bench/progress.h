// How far a long command has come, on standard error: one line that redraws itself on a terminal, a line every tenth
// elsewhere.
#pragma once
#include <chrono>
#include <string>

namespace caustream::bench {

class Progress {
   public:
    explicit Progress(std::string what);
    ~Progress();   // leaves the terminal's line empty

    // `share` of the whole, 0..1, and what is being done.
    void at(double share, const std::string& now = {});

   private:
    std::string what_;
    bool terminal_;
    int shown_ = -1;   // per cent on a terminal, tenths elsewhere
    std::chrono::steady_clock::time_point start_;
};

}  // namespace caustream::bench
