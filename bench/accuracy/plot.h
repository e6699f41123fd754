// Error against milliseconds as an SVG, both logarithmic.
#pragma once
#include <string>
#include <vector>

#include "bench/accuracy/pareto.h"

namespace caustream::bench {

struct PlotPoint {
    Cost cost;                  // > 0
    std::string family, label;
};

struct Plot {
    std::string title, subtitle;
    std::vector<PlotPoint> points;
    double noise = 0;           // the reference's own error: a dashed line below which nothing can be told apart; 0: none
};

// Points by family, the Pareto front as a staircase with its members named, budgets of 16 and 50 ms marked.
std::string svg(const Plot& plot);

}  // namespace caustream::bench
