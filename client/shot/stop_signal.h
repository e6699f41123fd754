// Ctrl-C and SIGTERM, for work that ends between two files and not within one.
#pragma once
#include <atomic>

namespace caustream::shot {

// From now on either signal sets what this returns; when it comes again, it ends the program at once. Call it once.
const std::atomic<bool>& stopSignal();

}  // namespace caustream::shot
