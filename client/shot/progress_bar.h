// How far a picture has converged or a batch has come, on standard error where that is a terminal; silent elsewhere.
#pragma once
#include <string>

#include "protocol/server_messages.h"

namespace caustream::shot {

class ProgressBar {
 public:
    ProgressBar();
    ~ProgressBar();  // clears its line
    ProgressBar(const ProgressBar&) = delete;

    void show(const protocol::Convergence& convergence);
    void show(double share, const std::string& text);  // 0..1
    void clear();                                      // for a line that is to stay

 private:
    bool terminal_, drawn_ = false;
};

}  // namespace caustream::shot
