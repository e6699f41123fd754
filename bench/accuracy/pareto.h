// Which of several configurations are worth having: those that nothing is both faster and more accurate than.
#pragma once
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace caustream::bench {

struct Cost {
    double ms = 0, error = 0;
};

// Indices of the front, fastest first. Of equals the first counts.
std::vector<std::size_t> paretoFront(std::span<const Cost> costs);

// The most accurate of those that take no longer than `budgetMs`; nothing where all do.
std::optional<std::size_t> bestWithin(std::span<const Cost> costs, double budgetMs = std::numeric_limits<double>::infinity());

}  // namespace caustream::bench
