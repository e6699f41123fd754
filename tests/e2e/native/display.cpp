#include "display.h"

#include <chrono>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

namespace caustream::e2e {
namespace {

// The XWD file format, version 7: words in big-endian order, then colour map entries of 12 bytes, then the picture.
constexpr int kHeaderSize = 0, kWidth = 4, kHeight = 5, kByteOrder = 7, kBitsPerPixel = 11, kBytesPerLine = 12,
              kColors = 19;

}  // namespace

Display::Display(int width, int height)
    // -displayfd 1: it finds a free number itself and says it.
    : xvfb_("Xvfb", {"-displayfd", "1", "-screen", "0", std::to_string(width) + "x" + std::to_string(height) + "x24",
                     "-nolisten", "tcp", "-fbdir", folder_.path}) {
    const std::string number = xvfb_.firstLine();
    if (number.empty()) throw std::runtime_error("Xvfb did not start; is the package xvfb installed?");
    name_ = ":" + number;
}

Environment Display::environment() const {
    return {{"DISPLAY", name_}, {"WAYLAND_DISPLAY", ""}, {"LIBGL_ALWAYS_SOFTWARE", "1"}};
}

Pixels Display::look() const {
    std::ifstream in(folder_ / "Xvfb_screen0", std::ios::binary);
    const std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(in), {}};
    const auto word = [&](int index) {
        const unsigned char* p = &bytes.at(static_cast<std::size_t>(4 * index) + 3) - 3;
        return static_cast<std::size_t>(p[0]) << 24 | static_cast<std::size_t>(p[1]) << 16 |
               static_cast<std::size_t>(p[2]) << 8 | p[3];
    };
    if (word(kBitsPerPixel) != 32 || word(kByteOrder) != 0)
        throw std::runtime_error("the screen is not of little-endian 32-bit pixels");
    Pixels out{static_cast<int>(word(kWidth)), static_cast<int>(word(kHeight)), 3, {}};
    const std::size_t start = word(kHeaderSize) + 12 * word(kColors);
    for (std::size_t y = 0; y < word(kHeight); ++y)
        for (std::size_t x = 0; x < word(kWidth); ++x)
            for (const std::size_t channel : {2u, 1u, 0u})
                out.values.push_back(bytes.at(start + y * word(kBytesPerLine) + 4 * x + channel));
    return out;
}

void Display::hand(std::vector<std::string> words) const {
    const Result result = run("xdotool", words, environment());
    if (result.exitCode != 0) throw std::runtime_error("xdotool: " + result.err);
}

void Display::drag(int x, int y, int dx, int dy, const std::string& key, int button) const {
    constexpr int kSteps = 10;
    const std::string held = std::to_string(button);
    hand({"mousemove", std::to_string(x), std::to_string(y)});
    // The window must have seen the pointer and the key before the button.
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    if (!key.empty()) hand({"keydown", key});
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    hand({"mousedown", held});
    for (int i = 1; i <= kSteps; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(60));
        hand({"mousemove", std::to_string(x + dx * i / kSteps), std::to_string(y + dy * i / kSteps)});
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    hand({"mouseup", held});
    if (!key.empty()) hand({"keyup", key});
}

}  // namespace caustream::e2e
