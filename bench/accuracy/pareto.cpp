#include "bench/accuracy/pareto.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace caustream::bench {

std::vector<std::size_t> paretoFront(std::span<const Cost> costs) {
    std::vector<std::size_t> order(costs.size()), front;
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tie(costs[a].ms, costs[a].error) < std::tie(costs[b].ms, costs[b].error);
    });
    for (const std::size_t i : order) {
        if (front.empty() || costs[i].error < costs[front.back()].error) front.push_back(i);
    }
    return front;
}

std::optional<std::size_t> bestWithin(std::span<const Cost> costs, double budgetMs) {
    std::optional<std::size_t> best;
    for (const std::size_t i : paretoFront(costs)) {
        if (costs[i].ms <= budgetMs) best = i;   // the front's error falls with its time
    }
    return best;
}

}  // namespace caustream::bench
