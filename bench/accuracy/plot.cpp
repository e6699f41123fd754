#include "bench/accuracy/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace caustream::bench {

namespace {

constexpr double kWidth = 860, kHeight = 560, kLeft = 70, kRight = 840, kTop = 92, kBottom = 505;
// Okabe & Ito 2008: told apart by the colour-blind, too.
constexpr std::array kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00"};

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, std::abs(value) < 1e4 ? "%.4g" : "%.0f", value);
    return text;
}

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '<') out += "&lt;";
        else if (c == '&') out += "&amp;";
        else out += c;
    }
    return out;
}

// Logarithmic: values -> pixels, from `low` to `high`.
struct Axis {
    double low, high, from, to;
    double at(double value) const { return from + (to - from) * std::log(value / low) / std::log(high / low); }
};

Axis axisOf(const std::vector<double>& values, double from, double to) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return {*low / 1.25, *high * 1.25, from, to};
}

// 1, 2, 5 of every decade within the axis.
std::vector<double> ticks(const Axis& axis) {
    std::vector<double> list;
    for (int decade = -6; decade < 7; ++decade) {
        for (const double step : {1.0, 2.0, 5.0}) {
            const double value = step * std::pow(10.0, decade);
            if (value >= axis.low && value <= axis.high) list.push_back(value);
        }
    }
    return list;
}

void text(std::ostream& out, double x, double y, const std::string& what, const std::string& more) {
    out << "<text x=\"" << number(x) << "\" y=\"" << number(y) << "\" " << more << ">" << escaped(what) << "</text>\n";
}

void marker(std::ostream& out, std::size_t family, double x, double y) {
    const std::string fill = "\" fill=\"" + std::string(kColours[family % kColours.size()]) + "\" stroke=\"white\"/>\n";
    const auto polygon = [&](const std::vector<std::array<double, 2>>& corners) {
        out << "<polygon points=\"";
        for (const auto& [dx, dy] : corners) out << number(x + dx) << "," << number(y + dy) << " ";
        out << fill;
    };
    switch (family % 4) {
        case 0: out << "<circle cx=\"" << number(x) << "\" cy=\"" << number(y) << "\" r=\"5.5" << fill; break;
        case 1: polygon({{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}); break;
        case 2: polygon({{0, -7}, {6, 5}, {-6, 5}}); break;
        default: polygon({{0, -7}, {7, 0}, {0, 7}, {-7, 0}});
    }
}

struct Box {
    double x0, y0, x1, y1;
    bool meets(const Box& other) const { return x0 < other.x1 && other.x0 < x1 && y0 < other.y1 && other.y0 < y1; }
};

// Labels beside their points, where nothing is yet; one that finds no place is left to the table.
class Labels {
   public:
    void occupy(double x, double y, double half) { taken_.push_back({x - half, y - half, x + half, y + half}); }
    void occupyBox(double x0, double y0, double x1, double y1) { taken_.push_back({x0, y0, x1, y1}); }

    void place(std::ostream& out, double x, double y, const std::string& what) {
        constexpr double kLetter = 6.1, kRow = 12;
        const double width = kLetter * static_cast<double>(what.size());
        for (const double away : {9.0, 18.0, 30.0, 44.0}) {
            for (const auto [left, bottom] : {std::array{x - away - width, y + away}, {x - away - width, y + 4}, {x - 0.5 * width, y + away + 7},
                                              {x + away, y - away + 6}, {x + away, y + 4}, {x - 0.5 * width, y - away}}) {
                const Box box{left, bottom - kRow + 2, left + width, bottom + 3};
                const bool inside = box.x0 > kLeft + 2 && box.x1 < kRight && box.y0 > kTop && box.y1 < kBottom - 2;
                if (!inside || std::any_of(taken_.begin(), taken_.end(), [&](const Box& other) { return box.meets(other); })) continue;
                taken_.push_back(box);
                if (away > 10.0) {
                    out << "<line x1=\"" << number(x) << "\" y1=\"" << number(y) << "\" x2=\"" << number(std::clamp(x, box.x0, box.x1)) << "\" y2=\""
                        << number(std::clamp(y, box.y0, box.y1)) << "\" stroke=\"#999\" stroke-width=\".7\"/>\n";
                }
                text(out, left, bottom, what, "font-size=\"11.5\"");
                return;
            }
        }
    }

   private:
    std::vector<Box> taken_;
};

}  // namespace

std::string svg(const Plot& plot) {
    std::vector<double> ms, errors;
    std::vector<Cost> costs;
    std::vector<std::string> families;
    for (const PlotPoint& point : plot.points) {
        ms.push_back(point.cost.ms), errors.push_back(point.cost.error), costs.push_back(point.cost);
        if (std::ranges::find(families, point.family) == families.end()) families.push_back(point.family);
    }
    if (plot.noise > 0) errors.push_back(plot.noise);
    if (ms.empty()) return {};
    const Axis x = axisOf(ms, kLeft, kRight), y = axisOf(errors, kBottom, kTop);

    std::ostringstream out;
    out << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << kWidth << " " << kHeight
        << "\" font-family=\"sans-serif\" font-size=\"12.5\" fill=\"#222\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    text(out, kLeft, 26, plot.title, "font-size=\"17\" font-weight=\"bold\"");
    text(out, kLeft, 46, plot.subtitle, "fill=\"#555\"");

    // Axes
    for (const double value : ticks(x)) {
        out << "<line x1=\"" << number(x.at(value)) << "\" y1=\"" << kTop << "\" x2=\"" << number(x.at(value)) << "\" y2=\"" << kBottom
            << "\" stroke=\"#e4e4e4\"/>\n";
        text(out, x.at(value), kBottom + 18, number(value), "text-anchor=\"middle\"");
    }
    for (const double value : ticks(y)) {
        out << "<line x1=\"" << kLeft << "\" y1=\"" << number(y.at(value)) << "\" x2=\"" << kRight << "\" y2=\"" << number(y.at(value))
            << "\" stroke=\"#e4e4e4\"/>\n";
        text(out, kLeft - 8, y.at(value) + 4, number(value), "text-anchor=\"end\"");
    }
    out << "<rect x=\"" << kLeft << "\" y=\"" << kTop << "\" width=\"" << kRight - kLeft << "\" height=\"" << kBottom - kTop
        << "\" fill=\"none\" stroke=\"#888\"/>\n";
    text(out, 0.5 * (kLeft + kRight), kBottom + 42, "whole frame after a move of the light, ms (median)", "text-anchor=\"middle\"");
    text(out, 0, 0, "relative L1 of the map's luminance", "text-anchor=\"middle\" transform=\"translate(20 298) rotate(-90)\"");
    for (const double budget : {16.0, 50.0}) {
        if (budget < x.low || budget > x.high) continue;
        out << "<line x1=\"" << number(x.at(budget)) << "\" y1=\"" << kTop << "\" x2=\"" << number(x.at(budget)) << "\" y2=\"" << kBottom
            << "\" stroke=\"#888\" stroke-dasharray=\"2 3\"/>\n";
        text(out, x.at(budget) + 4, kTop + 14, number(budget) + " ms", "fill=\"#666\" font-size=\"11\"");
    }
    if (plot.noise > 0) {
        out << "<line x1=\"" << kLeft << "\" y1=\"" << number(y.at(plot.noise)) << "\" x2=\"" << kRight << "\" y2=\"" << number(y.at(plot.noise))
            << "\" stroke=\"#888\" stroke-dasharray=\"7 4\"/>\n";
        text(out, kRight - 6, y.at(plot.noise) - 5, "the reference's own error", "text-anchor=\"end\" fill=\"#666\" font-size=\"11\"");
    }

    // Front, points, names of the front's members
    const std::vector<std::size_t> front = paretoFront(costs);
    out << "<polyline fill=\"none\" stroke=\"#222\" stroke-width=\"1.4\" points=\"";
    // A step: until the next member's time this one is the best there is.
    for (std::size_t i = 0; i < front.size(); ++i) {
        const Cost& own = costs[front[i]];
        if (i > 0) out << number(x.at(own.ms)) << "," << number(y.at(costs[front[i - 1]].error)) << " ";
        out << number(x.at(own.ms)) << "," << number(y.at(own.error)) << " ";
    }
    out << number(kRight) << "," << number(y.at(costs[front.back()].error)) << "\"/>\n";
    Labels labels;
    for (const PlotPoint& point : plot.points) {
        labels.occupy(x.at(point.cost.ms), y.at(point.cost.error), 7.0);
        const auto family = static_cast<std::size_t>(std::ranges::find(families, point.family) - families.begin());
        marker(out, family, x.at(point.cost.ms), y.at(point.cost.error));
    }
    for (std::size_t i = 0; i < front.size(); ++i) {   // names keep off the line
        const bool last = i + 1 == front.size();
        const double x0 = x.at(costs[front[i]].ms), x1 = last ? kRight : x.at(costs[front[i + 1]].ms);
        const double y0 = y.at(costs[front[i]].error), y1 = last ? y0 : y.at(costs[front[i + 1]].error);
        labels.occupyBox(x0, y0 - 1, x1, y0 + 1);
        labels.occupyBox(x1 - 1, std::min(y0, y1), x1 + 1, std::max(y0, y1));
    }
    for (const std::size_t i : front) labels.place(out, x.at(costs[i].ms), y.at(costs[i].error), plot.points[i].label);

    // Legend
    double at = kLeft + 6;
    for (std::size_t i = 0; i < families.size(); ++i) {
        marker(out, i, at, 72);
        text(out, at + 11, 76, families[i], "");
        at += 30 + 6.6 * static_cast<double>(families[i].size());
    }
    out << "<line x1=\"" << number(at - 6) << "\" y1=\"72\" x2=\"" << number(at + 18) << "\" y2=\"72\" stroke=\"#222\" stroke-width=\"1.4\"/>\n";
    text(out, at + 23, 76, "Pareto front", "");
    out << "</svg>\n";
    return out.str();
}

}  // namespace caustream::bench
