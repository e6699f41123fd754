#include "bench/stream/timeline.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace caustream::bench {
namespace {

constexpr double kWidth = 860, kHeight = 470, kLeft = 64, kRight = 840;
constexpr double kAgeTop = 70, kAgeBottom = 300, kLevelTop = 330, kLevelBottom = 430;
constexpr double kMostMs = 1000;   // ages above are drawn at the edge

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

void text(std::ostream& out, double x, double y, const std::string& what, const char* more) {
    out << "<text x=\"" << number(x) << "\" y=\"" << number(y) << "\" " << more << ">" << what << "</text>\n";
}

void line(std::ostream& out, double x0, double y0, double x1, double y1, const char* style) {
    out << "<line x1=\"" << number(x0) << "\" y1=\"" << number(y0) << "\" x2=\"" << number(x1) << "\" y2=\"" << number(y1) << "\" " << style
        << "/>\n";
}

}  // namespace

std::string timelineSvg(const std::string& title, const std::vector<TimelinePhase>& phases, const std::vector<TimelinePoint>& points,
                        double limitMs, int levels) {
    const double lastS = phases.empty() ? 1.0 : phases.back().toS;
    const auto x = [&](double s) { return kLeft + (kRight - kLeft) * s / lastS; };
    // Square roots: small ages and large ones in one picture.
    const auto age = [](double ms) { return kAgeBottom - (kAgeBottom - kAgeTop) * std::sqrt(std::clamp(ms, 0.0, kMostMs) / kMostMs); };
    const auto level = [&](int l) { return kLevelTop + (kLevelBottom - kLevelTop) * l / std::max(1, levels - 1); };

    std::ostringstream out;
    out << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << kWidth << " " << kHeight
        << "\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    text(out, kLeft, 26, title, "font-size=\"16\" font-weight=\"bold\"");
    for (const TimelinePhase& phase : phases) {
        line(out, x(phase.fromS), 48, x(phase.fromS), kLevelBottom, "stroke=\"#888\"");
        text(out, x(phase.fromS) + 5, 60, phase.name, "fill=\"#555\"");
    }
    for (const double ms : {0.0, 20.0, 50.0, 150.0, 500.0, 1000.0}) {
        line(out, kLeft, age(ms), kRight, age(ms), ms == limitMs ? "stroke=\"#D55E00\" stroke-dasharray=\"6 4\"" : "stroke=\"#e4e4e4\"");
        text(out, kLeft - 8, age(ms) + 4, number(ms), "text-anchor=\"end\"");
    }
    for (int l = 0; l < levels; ++l) {
        line(out, kLeft, level(l), kRight, level(l), "stroke=\"#e4e4e4\"");
        text(out, kLeft - 8, level(l) + 4, std::to_string(l), "text-anchor=\"end\"");
    }
    for (double s = 0; s <= lastS; s += 5) text(out, x(s), kLevelBottom + 18, number(s), "text-anchor=\"middle\"");
    text(out, 0, 0, "frame age, ms", "text-anchor=\"middle\" transform=\"translate(18 185) rotate(-90)\"");
    text(out, 0, 0, "level", "text-anchor=\"middle\" transform=\"translate(18 380) rotate(-90)\"");
    text(out, 0.5 * (kLeft + kRight), kHeight - 6, "s", "text-anchor=\"middle\"");

    for (const TimelinePoint& point : points) {
        out << "<circle cx=\"" << number(x(point.s)) << "\" cy=\"" << number(age(point.ageMs)) << "\" r=\"1.3\" fill=\"#0072B2\"/>\n";
    }
    out << "<polyline fill=\"none\" stroke=\"#009E73\" stroke-width=\"1.6\" points=\"";
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (i > 0 && points[i].level != points[i - 1].level) out << number(x(points[i].s)) << "," << number(level(points[i - 1].level)) << " ";
        if (i == 0 || points[i].level != points[i - 1].level || i + 1 == points.size()) {
            out << number(x(points[i].s)) << "," << number(level(points[i].level)) << " ";
        }
    }
    out << "\"/>\n</svg>\n";
    return out.str();
}

}  // namespace caustream::bench
