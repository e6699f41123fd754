// Who waits for a file hears how far reading has come, and may end it.
#pragma once
#include <functional>

namespace caustream::scene {

// Called now and then from the thread that reads, with a share that only grows, 0..1. False: no one wants the file any
// more.
using LoadObserver = std::function<bool(double)>;

}  // namespace caustream::scene
