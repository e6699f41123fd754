#include "bench/accuracy/colour_difference.h"

#include <array>
#include <cassert>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "bench/statistics.h"

namespace caustream::bench {

namespace {

// IEC 61966-2-1.
double linear(std::uint8_t value) {
    const double s = value / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

double square(double x) { return x * x; }

double hueDeg(double a, double b) {
    if (a == 0.0 && b == 0.0) return 0.0;
    const double h = glm::degrees(std::atan2(b, a));
    return h < 0.0 ? h + 360.0 : h;
}

double cosDeg(double deg) { return std::cos(glm::radians(deg)); }

}  // namespace

// CIE 15:2004, Eqs. 8.3-8.8; white is sRGB's own.
glm::dvec3 labOfSrgb(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
    static const std::array<double, 256> table = [] {
        std::array<double, 256> values{};
        for (int i = 0; i < 256; ++i) values[static_cast<std::size_t>(i)] = linear(static_cast<std::uint8_t>(i));
        return values;
    }();
    const double R = table[r], G = table[g], B = table[b];
    // Rows over their own sums, so that white is (1, 1, 1).
    const auto f = [](double t) { return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0; };
    const double x = f((0.4124 * R + 0.3576 * G + 0.1805 * B) / 0.9505), y = f(0.2126 * R + 0.7152 * G + 0.0722 * B),
                 z = f((0.0193 * R + 0.1192 * G + 0.9505 * B) / 1.0890);
    return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

double ciede2000(const glm::dvec3& lab1, const glm::dvec3& lab2) {
    constexpr double k25To7 = 6103515625.0;
    const double meanC = 0.5 * (std::hypot(lab1.y, lab1.z) + std::hypot(lab2.y, lab2.z));
    const double c7 = std::pow(meanC, 7.0);
    const double G = 0.5 * (1.0 - std::sqrt(c7 / (c7 + k25To7)));
    const double a1 = (1.0 + G) * lab1.y, a2 = (1.0 + G) * lab2.y;
    const double C1 = std::hypot(a1, lab1.z), C2 = std::hypot(a2, lab2.z);
    const double h1 = hueDeg(a1, lab1.z), h2 = hueDeg(a2, lab2.z);
    const bool grey = C1 * C2 == 0.0;

    double dh = grey ? 0.0 : h2 - h1;
    if (dh > 180.0) dh -= 360.0;
    if (dh < -180.0) dh += 360.0;
    const double dL = lab2.x - lab1.x, dC = C2 - C1;
    const double dH = 2.0 * std::sqrt(C1 * C2) * std::sin(glm::radians(0.5 * dh));

    double h = h1 + h2;
    if (!grey) {
        if (std::abs(h1 - h2) > 180.0) h += h < 360.0 ? 360.0 : -360.0;
        h *= 0.5;
    }
    const double L = 0.5 * (lab1.x + lab2.x), C = 0.5 * (C1 + C2);
    const double T = 1.0 - 0.17 * cosDeg(h - 30.0) + 0.24 * cosDeg(2.0 * h) + 0.32 * cosDeg(3.0 * h + 6.0) - 0.20 * cosDeg(4.0 * h - 63.0);
    const double SL = 1.0 + 0.015 * square(L - 50.0) / std::sqrt(20.0 + square(L - 50.0));
    const double SC = 1.0 + 0.045 * C, SH = 1.0 + 0.015 * C * T;
    const double cBar7 = std::pow(C, 7.0);
    const double turnDeg = 60.0 * std::exp(-square((h - 275.0) / 25.0));
    const double RT = -2.0 * std::sqrt(cBar7 / (cBar7 + k25To7)) * std::sin(glm::radians(turnDeg));
    const double l = dL / SL, c = dC / SC, hue = dH / SH;
    return std::sqrt(l * l + c * c + hue * hue + RT * c * hue);
}

PictureDifference pictureDifference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    assert(a.size() == b.size() && a.size() % 3 == 0);
    std::vector<double> differences;
    differences.reserve(a.size() / 3);
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); i += 3) {
        const bool same = a[i] == b[i] && a[i + 1] == b[i + 1] && a[i + 2] == b[i + 2];
        differences.push_back(same ? 0.0 : ciede2000(labOfSrgb(a[i], a[i + 1], a[i + 2]), labOfSrgb(b[i], b[i + 1], b[i + 2])));
        sum += differences.back();
    }
    if (differences.empty()) return {};
    return {sum / static_cast<double>(differences.size()), quantile(std::move(differences), 0.99)};
}

}  // namespace caustream::bench
