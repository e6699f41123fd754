#pragma once
#include <chrono>
#include <cstdint>

namespace caustream::session {

inline constexpr std::uint64_t kUsPerS = 1'000'000;

// Monotonic microseconds: the server's clock on the wire.
inline std::uint64_t nowUs() {
    return static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now().time_since_epoch()).count());
}

}  // namespace caustream::session
