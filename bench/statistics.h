// What measurements are summed up with.
#pragma once
#include <vector>

namespace caustream::bench {

// The value that `share` (0..1) of the values lie below, interpolated; 0 of none.
double quantile(std::vector<double> values, double share);
inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

// Milliseconds for a fixed loop of arithmetic on one core, to set beside absolute times of different machines.
double calibrationMs();

}  // namespace caustream::bench
