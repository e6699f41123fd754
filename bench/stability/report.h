// What the cases gave, as a table for people, as Markdown for docs/accuracy.md and as lines of JSON.
#pragma once
#include <cstdio>
#include <string>
#include <vector>

#include "bench/stability/examine.h"

namespace caustream::stability {

struct Result {
    std::string group, name, mode;
    bool mustPass = true;
    Outcome outcome;
};

// Failures of modes that must pass.
int failuresThatCount(const std::vector<Result>& results);

// One line per group and mode, then the failures, each with what reproduces it, then the residuals.
std::string textReport(const std::vector<Result>& results);
std::string markdownReport(const std::vector<Result>& results);
std::string jsonLine(const Result& result);

}  // namespace caustream::stability
