#include "client/connection/image.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace caustream::connection {
namespace {

using protocol::Sample;

// IEC 61966-2-1, the encoding direction; through a table, as pow() a quarter of a million times takes 20 ms.
std::uint8_t srgbByte(float linear) {
    constexpr int kSteps = 4096;
    static const auto table = [] {
        std::array<std::uint8_t, kSteps + 1> out{};
        for (int i = 0; i <= kSteps; ++i) {
            // Steps are even in the square root, so that the dark end, where the curve is steep, has enough of them.
            const double root = static_cast<double>(i) / kSteps, x = root * root;
            const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
            out[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(255.0 * encoded));
        }
        return out;
    }();
    if (!(linear > 0.0f)) return 0;  // also what is not a number
    const float root = std::sqrt(std::min(linear, 1.0f));
    return table[static_cast<std::size_t>(root * kSteps + 0.5f)];
}

std::array<float, 3> colourOf(const float* texel, int bands) {
    if (bands == 1) return {texel[0], texel[0], texel[0]};
    if (bands == 2) return {texel[1], 0.5f * (texel[0] + texel[1]), texel[0]};
    if (bands == 3) return {texel[0], texel[1], texel[2]};
    std::array<float, 3> sum{}, count{};
    for (int band = 0; band < bands; ++band) {
        const auto third = static_cast<std::size_t>(2 - 3 * band / bands);
        sum[third] += texel[band];
        count[third] += 1.0f;
    }
    return {sum[0] / count[0], sum[1] / count[1], sum[2] / count[2]};
}

}  // namespace

float halfToFloat(std::uint16_t half) {
    const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000u) << 16;
    const std::uint32_t exponent = (half >> 10) & 0x1fu, mantissa = half & 0x3ffu;
    if (exponent == 0) {
        const float value = std::ldexp(static_cast<float>(mantissa), -24);  // zero and subnormal
        return sign ? -value : value;
    }
    const std::uint32_t wide = exponent == 31 ? 255u : exponent + 112u;  // infinity and NaN keep their kind
    return std::bit_cast<float>(sign | (wide << 23) | (mantissa << 13));
}

std::vector<float> toFloats(const Image& image) {
    std::vector<float> out(image.samples());
    switch (image.sample) {
        case Sample::U8:
            for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<float>(image.data[i]) / 255.0f;
            break;
        case Sample::F16:
            for (std::size_t i = 0; i < out.size(); ++i) {
                std::uint16_t half = 0;
                std::memcpy(&half, &image.data[2 * i], 2);
                out[i] = halfToFloat(half) * image.scale;
            }
            break;
        case Sample::F32:
            std::memcpy(out.data(), image.data.data(), 4 * out.size());
            for (float& value : out) value *= image.scale;
            break;
    }
    return out;
}

float whiteLevel(const std::vector<float>& linear, int bands, double fraction) {
    std::vector<float> largest;
    const auto step = static_cast<std::size_t>(bands);
    largest.reserve(linear.size() / step);
    for (std::size_t i = 0; i + step <= linear.size(); i += step) {
        const float value = *std::max_element(&linear[i], &linear[i] + step);
        if (std::isfinite(value) && value > 0.0f) largest.push_back(value);
    }
    if (largest.empty()) return 1.0f;
    const auto nth = largest.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(largest.size() - 1));
    std::nth_element(largest.begin(), nth, largest.end());
    return *nth;
}

Image toPicture(const Image& image, float white) {
    Image out{image.width, image.height, 3, Sample::U8, 1.0f, {}};
    const std::size_t texels = out.samples() / 3;
    out.data.resize(3 * texels);
    if (image.sample == Sample::U8 && image.bands == 3) {
        out.data = image.data;
        return out;
    }

    const std::vector<float> values = toFloats(image);
    const bool linear = image.sample != Sample::U8;
    if (linear && white <= 0.0f) white = whiteLevel(values, image.bands);
    for (std::size_t i = 0; i < texels; ++i) {
        const auto colour = colourOf(&values[i * static_cast<std::size_t>(image.bands)], image.bands);
        for (std::size_t c = 0; c < 3; ++c)
            out.data[3 * i + c] =
                linear ? srgbByte(colour[c] / white) : static_cast<std::uint8_t>(std::lround(255.0f * colour[c]));
    }
    return out;
}

}  // namespace caustream::connection
