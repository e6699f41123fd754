// Four levels of `key=value` lines on standard error. Any thread may log; a line is written in one piece.
#pragma once
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

namespace caustream::log {

enum class Level { Debug, Info, Warning, Error };

// "debug", "info", "warning" or "error"; nothing otherwise.
std::optional<Level> levelFromName(std::string_view name);

void setLevel(Level level);
bool enabled(Level level);

// One line; values that hold spaces or quotes are quoted, line breaks become spaces.
class Line {
   public:
    Line(Level level, std::string_view event);
    ~Line();
    Line(const Line&) = delete;
    Line& operator=(const Line&) = delete;

    Line& with(std::string_view key, std::string_view value);
    Line& with(std::string_view key, const char* value) { return with(key, std::string_view(value)); }
    template <typename Number>
        requires std::is_arithmetic_v<Number>
    Line& with(std::string_view key, Number value) {
        std::ostringstream text;
        text << value;
        return with(key, std::string_view(text.str()));
    }

   private:
    bool enabled_;
    std::string text_;
};

inline Line debug(std::string_view event) { return Line(Level::Debug, event); }
inline Line info(std::string_view event) { return Line(Level::Info, event); }
inline Line warning(std::string_view event) { return Line(Level::Warning, event); }
inline Line error(std::string_view event) { return Line(Level::Error, event); }

}  // namespace caustream::log
