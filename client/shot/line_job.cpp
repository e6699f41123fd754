#include "client/shot/line_job.h"

#include <algorithm>
#include <sstream>

namespace caustream::shot {

const char* nameOf(Format format) {
    return format == Format::Png ? "png" : format == Format::Npy ? "npy" : "exr";
}

tl::expected<std::vector<Format>, std::string> parseFormats(const std::string& text) {
    std::vector<Format> formats;
    std::istringstream in(text);
    for (std::string name; std::getline(in, name, ',');) {
        const auto* known = std::ranges::find_if(kFormats, [&](Format f) { return name == nameOf(f); });
        if (known == std::end(kFormats)) return tl::make_unexpected("--format " + text + ": there are png, npy and exr, parted by commas");
        if (std::ranges::find(formats, *known) == formats.end()) formats.push_back(*known);
    }
    if (formats.empty()) return tl::make_unexpected(std::string("--format: at least one of png, npy and exr"));
    std::ranges::sort(formats);
    return formats;
}

bool holds(Format format, const std::string& target) {
    const bool numbers = target == "spectral" || target == "bands" || target == "depth";
    const bool both = target == "composite" || target == "normals" || target == "caster_mask";
    return format == Format::Png ? !numbers : numbers || both;
}

}  // namespace caustream::shot
