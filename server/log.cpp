#include "log.h"

#include <array>
#include <atomic>
#include <cstdio>
#include <ctime>

namespace caustream::log {
namespace {

constexpr std::array<std::string_view, 4> kNames = {"debug", "info", "warning", "error"};

std::atomic<Level> threshold{Level::Info};

std::string utcNow() {
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    tm parts{};
    gmtime_r(&now.tv_sec, &parts);
    char date[32];
    const std::size_t length = strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S", &parts);
    char text[48];
    std::snprintf(text, sizeof text, "%.*s.%03ldZ", static_cast<int>(length), date, now.tv_nsec / 1'000'000);
    return text;
}

}  // namespace

std::optional<Level> levelFromName(std::string_view name) {
    for (std::size_t i = 0; i < kNames.size(); ++i) {
        if (kNames[i] == name) {
            return static_cast<Level>(i);
        }
    }
    return std::nullopt;
}

void setLevel(Level level) { threshold = level; }

bool enabled(Level level) { return level >= threshold.load(std::memory_order_relaxed); }

Line::Line(Level level, std::string_view event) : enabled_(enabled(level)) {
    if (enabled_) {
        text_ = utcNow() + " " + std::string(kNames[static_cast<std::size_t>(level)]);
        with("event", event);
    }
}

Line::~Line() {
    if (enabled_) {
        text_ += '\n';
        std::fwrite(text_.data(), 1, text_.size(), stderr);
    }
}

Line& Line::with(std::string_view key, std::string_view value) {
    if (!enabled_) {
        return *this;
    }
    const bool quoted = value.empty() || value.find_first_of(" \"=\\\n\r\t") != std::string_view::npos;
    text_.append(" ").append(key).append("=");
    if (!quoted) {
        text_.append(value);
        return *this;
    }
    text_ += '"';
    for (const char c : value) {
        if (c == '"' || c == '\\') {
            text_ += '\\';
        }
        text_ += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    text_ += '"';
    return *this;
}

}  // namespace caustream::log
