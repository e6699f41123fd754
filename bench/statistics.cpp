#include "bench/statistics.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace caustream::bench {

double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0.0;
    std::sort(values.begin(), values.end());
    const double at = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return std::lerp(values[below], values[above], at - static_cast<double>(below));
}

double calibrationMs() {
    const auto start = std::chrono::steady_clock::now();
    const volatile double seed = 1.0;   // volatile at both ends, or the loop is moved out of the clock
    double x = seed;
    for (int i = 0; i < 50'000'000; ++i) x = x * 0.999999999 + 1e-9;
    const volatile double kept = x;
    static_cast<void>(kept);
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace caustream::bench
