#include "bench/stream/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace caustream::bench {
namespace {

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, std::abs(value) < 1e4 ? "%.3g" : "%.0f", value);
    return text;
}

const char* verdict(const Figure& figure) { return figure.limit.empty() ? "" : figure.held ? "PASS" : "MISS"; }

}  // namespace

void Report::atMost(const std::string& name, double value, double most, const std::string& unit) {
    figures_.push_back({scenario_, name, unit, value, "<= " + number(most), value <= most});
}

void Report::atLeast(const std::string& name, double value, double least, const std::string& unit) {
    figures_.push_back({scenario_, name, unit, value, ">= " + number(least), value >= least});
}

void Report::shown(const std::string& name, double value, const std::string& unit) {
    figures_.push_back({scenario_, name, unit, value, "", true});
}

void Report::note(const std::string& text) { notes_.push_back(text); }

void Report::print() const {
    for (const std::string& note : notes_) std::printf("%s: %s\n", scenario_.c_str(), note.c_str());
    for (const Figure& figure : figures_) {
        std::printf("%-4s  %-62s %9s %-6s %s\n", verdict(figure), (scenario_ + ": " + figure.name).c_str(), number(figure.value).c_str(),
                    figure.unit.c_str(), figure.limit.c_str());
    }
    std::fflush(stdout);
}

std::string Report::json() const {
    std::string lines;
    for (const Figure& figure : figures_) {
        nlohmann::json line = {{"scenario", scenario_}, {"figure", figure.name}, {"value", figure.value}, {"unit", figure.unit}};
        if (!figure.limit.empty()) line.update({{"limit", figure.limit}, {"held", figure.held}});
        lines += line.dump() + "\n";
    }
    return lines;
}

std::string Report::markdown() const {
    std::string rows;
    for (const Figure& figure : figures_) {
        rows += "| " + scenario_ + " | " + figure.name + " | " + number(figure.value) + " " + figure.unit + " | " + figure.limit + " | " +
                (figure.limit.empty() ? "" : figure.held ? "yes" : "**no**") + " |\n";
    }
    return rows;
}

bool Report::held() const {
    return std::ranges::all_of(figures_, [](const Figure& figure) { return figure.held; });
}

}  // namespace caustream::bench
