// How far a picture has converged, on standard error where that is a terminal; silent elsewhere.
#pragma once
#include "protocol/server_messages.h"

namespace caustream::shot {

class ProgressBar {
 public:
    ProgressBar();
    ~ProgressBar();  // clears its line
    ProgressBar(const ProgressBar&) = delete;

    void show(const protocol::Convergence& convergence);

 private:
    bool terminal_, drawn_ = false;
};

}  // namespace caustream::shot
