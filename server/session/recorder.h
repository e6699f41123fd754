// A session's log: what was asked of it and when, one JSON object a line, for caustream-shot --replay (docs/batch.md has
// the format). Network thread only.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "protocol/json_text.h"

namespace caustream::session {

class Recorder {
   public:
    static constexpr std::size_t kLogBytes = 64u << 20;  // hours of dragging at 100 inputs a second, 200 bytes each
    static constexpr int kLogsOfASession = 100;

    // Makes `folder`/<session>-<n>.jsonl, n the first that is free, for its owner's eyes only, and writes `header` to it.
    // The error is a sentence; an id that is no plain word of letters and digits names no file.
    static tl::expected<Recorder, std::string> start(const std::string& folder, const std::string& session,
                                                     protocol::Json header, std::size_t mostBytes = kLogBytes);
    // Ends the log.
    ~Recorder();
    Recorder(Recorder&& other) noexcept;
    Recorder& operator=(Recorder&&) = delete;

    // Adds a line with the time since the start, `t_us`; it is the file's when this returns. A sentence: the log is full or
    // cannot be written, and has ended; whatever follows is not noted.
    std::optional<std::string> note(protocol::Json line);

    const std::string& file() const { return name_; }  // within the folder

   private:
    Recorder(int descriptor, std::string name, std::size_t mostBytes);
    std::string write(const protocol::Json& line);
    void end(const std::string& why);

    int descriptor_ = -1;
    std::string name_;
    std::size_t mostBytes_, bytes_ = 0;
    std::uint64_t startUs_;
};

}  // namespace caustream::session
