#include "client/connection/readings.h"

namespace caustream::connection {
namespace {

constexpr int kFixedLevel = 255;

std::string size(unsigned width, unsigned height) {
    return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

std::string qualityText(const protocol::FrameHeader& header) {
    if (header.encoding != protocol::Encoding::Jpeg) return "without loss";
    return (header.level == kFixedLevel ? "fixed" : "level " + std::to_string(header.level)) + ", JPEG " +
           std::to_string(header.jpegQuality);
}

std::string sizeText(const protocol::FrameHeader& header) {
    const std::string text = size(header.width, header.height);
    return header.flags & protocol::kFrameScaled ? text + ", shown at " + size(header.viewWidth, header.viewHeight) : text;
}

std::string dropsText(const protocol::Drops& drops) {
    std::string text;
    if (drops.replaced > 0) text = std::to_string(drops.replaced) + " replaced";
    if (drops.outdated > 0) text += (text.empty() ? "" : ", ") + std::to_string(drops.outdated) + " outdated";
    return text.empty() ? "none" : text;
}

}  // namespace caustream::connection
