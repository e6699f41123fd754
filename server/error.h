// Something in the environment (a file, the GPU, a port) is not as needed: what, where, and what to try, in one line.
#pragma once
#include <stdexcept>

namespace caustream {

struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The GPU had no memory for it: perhaps for this picture, perhaps for any.
struct OutOfMemory : Error {
    using Error::Error;
};

}  // namespace caustream
