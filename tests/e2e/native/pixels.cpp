#include "pixels.h"

#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

namespace caustream::e2e {
namespace {

std::vector<unsigned char> bytesOf(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw std::runtime_error("no file " + file);
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

float Pixels::luminance(int x, int y) const {
    const float* p = &values[static_cast<std::size_t>((y * width + x) * bands)];
    return bands == 3 ? 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2] : p[0];
}

float Pixels::largest(int x, int y) const {
    const float* p = &values[static_cast<std::size_t>((y * width + x) * bands)];
    return *std::max_element(p, p + bands);
}

double Pixels::quantile(double fraction) const {
    std::vector<float> all;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) all.push_back(luminance(x, y));
    const auto nth = all.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(all.size() - 1));
    std::nth_element(all.begin(), nth, all.end());
    return *nth;
}

double Pixels::mean() const {
    double sum = 0.0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) sum += luminance(x, y);
    return sum / (width * height);
}

Pixels readPng(const std::string& file) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_file(&png, file.c_str())) throw std::runtime_error(file + ": " + png.message);
    png.format = PNG_FORMAT_RGB;
    std::vector<unsigned char> bytes(PNG_IMAGE_SIZE(png));
    if (!png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr))
        throw std::runtime_error(file + ": " + png.message);
    return {static_cast<int>(png.width), static_cast<int>(png.height), 3, {bytes.begin(), bytes.end()}};
}

Pixels readJpeg(const std::string& file) {
    const auto bytes = bytesOf(file);
    const std::unique_ptr<void, int (*)(tjhandle)> decoder(tjInitDecompress(), tjDestroy);
    int width = 0, height = 0, subsampling = 0, space = 0;
    if (tjDecompressHeader3(decoder.get(), bytes.data(), bytes.size(), &width, &height, &subsampling, &space) != 0)
        throw std::runtime_error(file + ": " + tjGetErrorStr2(decoder.get()));
    std::vector<unsigned char> pixels(static_cast<std::size_t>(width * height * 3));
    if (tjDecompress2(decoder.get(), bytes.data(), bytes.size(), pixels.data(), width, 0, height, TJPF_RGB, 0) != 0)
        throw std::runtime_error(file + ": " + tjGetErrorStr2(decoder.get()));
    return {width, height, 3, {pixels.begin(), pixels.end()}};
}

Pixels readNpy(const std::string& file) {
    const auto bytes = bytesOf(file);
    if (bytes.size() < 10 || std::memcmp(bytes.data(), "\x93NUMPY\x01\x00", 8) != 0)
        throw std::runtime_error(file + " is no NPY file");
    const std::size_t start = 10u + bytes[8] + 256u * bytes[9];
    if (start % 64 != 0 || bytes.size() < start) throw std::runtime_error(file + ": the header's length is wrong");
    const std::string header(bytes.begin() + 10, bytes.begin() + static_cast<std::ptrdiff_t>(start));
    Pixels out;
    const auto shape = header.find("'shape': (");
    if (header.find("'descr': '<f4'") == header.npos || shape == header.npos ||
        std::sscanf(header.c_str() + shape + 10, "%d, %d, %d)", &out.height, &out.width, &out.bands) != 3)
        throw std::runtime_error(file + ": the header is " + header);
    out.values.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height) *
                      static_cast<std::size_t>(out.bands));
    if (bytes.size() != start + 4 * out.values.size())
        throw std::runtime_error(file + " has not the size its shape says");
    std::memcpy(out.values.data(), &bytes[start], 4 * out.values.size());
    return out;
}

Centroid centroidAbove(const Pixels& pixels, double threshold) {
    Centroid sum;
    for (int y = 0; y < pixels.height; ++y)
        for (int x = 0; x < pixels.width; ++x) {
            if (pixels.luminance(x, y) <= threshold) continue;
            sum.x += x;
            sum.y += y;
            ++sum.count;
        }
    if (sum.count > 0) {
        sum.x /= sum.count;
        sum.y /= sum.count;
    }
    return sum;
}

}  // namespace caustream::e2e
