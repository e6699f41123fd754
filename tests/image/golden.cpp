#include "tests/image/golden.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <sstream>
#include <stdexcept>

#include "bench/reference/npy.h"

namespace caustream::image {

namespace {

void writeDifference(const std::string& path, const std::vector<double>& differences, int width, int height, double white) {
    std::vector<std::uint8_t> texels;
    for (const double d : differences) texels.push_back(static_cast<std::uint8_t>(std::lround(255.0 * std::min(1.0, d / white))));
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.format = PNG_FORMAT_RGB;
    image.width = static_cast<png_uint_32>(width);
    image.height = static_cast<png_uint_32>(height);
    png_image_write_to_file(&image, path.c_str(), 0, texels.data(), 0, nullptr);
}

std::string pathOf(const std::string& folder, const std::string& name) { return folder + "/" + name + ".npy.gz"; }

}  // namespace

void writeGolden(const std::string& folder, const std::string& name, const std::vector<float>& rgb, int width, int height) {
    npy::write(pathOf(folder, name), {static_cast<std::size_t>(height), static_cast<std::size_t>(width), 3}, rgb);
}

std::string compareWithGolden(const std::string& folder, const std::string& name, const std::vector<float>& rgb, int width,
                              int height, const Tolerance& tolerance) {
    for (const float value : rgb) {
        if (!std::isfinite(value)) return name + " holds a value that is not finite";
    }
    const npy::Array golden = npy::read(pathOf(folder, name));
    if (golden.values.size() != rgb.size()) return name + " has another size than its golden";

    std::vector<double> differences;
    double sum = 0.0, most = 0.0;
    for (std::size_t i = 0; i < rgb.size(); ++i) {
        const double limit = std::max(1.0, double(golden.values[i]));
        differences.push_back(std::abs(double(rgb[i]) - double(golden.values[i])) / limit);
        sum += differences.back();
        most = std::max(most, differences.back());
    }
    std::vector<std::pair<double, std::size_t>> pixels;   // worst channel of each
    for (std::size_t i = 0; i < differences.size(); i += 3) {
        pixels.emplace_back(std::max({differences[i], differences[i + 1], differences[i + 2]}), i / 3);
    }
    const auto failing = std::count_if(pixels.begin(), pixels.end(), [&](const auto& pixel) { return pixel.first > tolerance.pixel; });
    const double fraction = double(failing) / double(pixels.size()), mean = sum / double(differences.size());
    if (fraction <= tolerance.fraction && mean <= tolerance.mean) return "";

    const std::string picture = name + "-difference.png";
    writeDifference(picture, differences, width, height, 4.0 * tolerance.pixel);
    std::ostringstream report;
    report << name << ": max " << most << ", mean " << mean << " (" << tolerance.mean << " allowed), " << 100.0 * fraction
           << "% of the pixels above " << tolerance.pixel << " (" << 100.0 * tolerance.fraction << "% allowed); see " << picture;
    std::partial_sort(pixels.begin(), pixels.begin() + 10, pixels.end(), std::greater());
    for (std::size_t k = 0; k < 10; ++k) {
        const std::size_t at = pixels[k].second, i = 3 * at;
        report << "\n  (" << at % std::size_t(width) << ", " << at / std::size_t(width) << ") is " << rgb[i] << " " << rgb[i + 1] << " "
               << rgb[i + 2] << ", was " << golden.values[i] << " " << golden.values[i + 1] << " " << golden.values[i + 2];
    }
    return report.str();
}

}  // namespace caustream::image
