#include "client/connection/convergence_text.h"

#include <cstdio>

namespace caustream::connection {

std::string countText(std::uint64_t count) {
    char text[32];
    const auto number = static_cast<double>(count);
    if (count >= 999'950'000)
        std::snprintf(text, sizeof text, "%.1f billion", number / 1e9);
    else if (count >= 999'500)
        std::snprintf(text, sizeof text, "%.1f million", number / 1e6);
    else if (count >= 10'000)
        std::snprintf(text, sizeof text, "%.0f thousand", number / 1e3);
    else if (count >= 1000)
        std::snprintf(text, sizeof text, "%u,%03u", static_cast<unsigned>(count / 1000), static_cast<unsigned>(count % 1000));
    else
        std::snprintf(text, sizeof text, "%u", static_cast<unsigned>(count));
    return text;
}

std::string convergenceText(const protocol::Convergence& convergence) {
    char text[32];
    std::snprintf(text, sizeof text, convergence.error < 0.1 ? "%.1f%%" : "%.0f%%", 100.0 * convergence.error);
    return countText(convergence.photons) + " photons, error about " + text;
}

}  // namespace caustream::connection
