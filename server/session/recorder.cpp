#include "session/recorder.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <utility>

#include "session/clock.h"

namespace caustream::session {
namespace {

constexpr std::size_t kEndBytes = 256;  // more than the line that says why it ends

}  // namespace

tl::expected<Recorder, std::string> Recorder::start(const std::string& folder, const std::string& session,
                                                    protocol::Json header, std::size_t mostBytes) {
    // A client may bring its session's id; it names a file only if it is as the server makes them.
    const auto plain = [](unsigned char c) { return std::isalnum(c) != 0; };
    if (session.empty() || session.size() > 64 || !std::ranges::all_of(session, plain)) {
        return tl::unexpected(std::string("a session of this name is not recorded"));
    }
    for (int n = 1; n <= kLogsOfASession; ++n) {
        const std::string name = session + "-" + std::to_string(n) + ".jsonl";
        const int descriptor = open((folder + "/" + name).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
        if (descriptor < 0 && errno == EEXIST) {
            continue;
        }
        if (descriptor < 0) {
            return tl::unexpected("the server cannot write its logs: " + std::string(std::strerror(errno)));
        }
        Recorder recorder(descriptor, name, mostBytes);
        header["caustream_log"] = 1;
        header["session"] = session;
        if (std::string why = recorder.write(header); !why.empty()) {
            return tl::unexpected(std::move(why));
        }
        return recorder;
    }
    return tl::unexpected("this session has " + std::to_string(kLogsOfASession) + " logs already");
}

Recorder::Recorder(int descriptor, std::string name, std::size_t mostBytes)
    : descriptor_(descriptor), name_(std::move(name)), mostBytes_(mostBytes), startUs_(nowUs()) {}

Recorder::Recorder(Recorder&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      name_(std::move(other.name_)),
      mostBytes_(other.mostBytes_),
      bytes_(other.bytes_),
      startUs_(other.startUs_) {}

Recorder::~Recorder() { end("recording ended"); }

std::optional<std::string> Recorder::note(protocol::Json line) {
    if (descriptor_ < 0) {
        return std::nullopt;
    }
    line["t_us"] = nowUs() - startUs_;
    std::string why = write(line);
    if (why.empty()) {
        return std::nullopt;
    }
    end(why);
    return why;
}

// Empty, or why the line is not in the file.
std::string Recorder::write(const protocol::Json& line) {
    const std::string text = line.dump(-1, ' ', false, protocol::Json::error_handler_t::replace) + "\n";
    if (bytes_ + text.size() > mostBytes_) {
        return "the log has its " + std::to_string(mostBytes_) + " bytes: nothing more is recorded";
    }
    // One call for one line: whatever kills the server leaves whole lines.
    const ssize_t written = ::write(descriptor_, text.data(), text.size());
    if (written != static_cast<ssize_t>(text.size())) {
        return "the log cannot be written: " + std::string(written < 0 ? std::strerror(errno) : "the disk is full");
    }
    bytes_ += text.size();
    return {};
}

void Recorder::end(const std::string& why) {
    if (descriptor_ < 0) {
        return;
    }
    mostBytes_ += kEndBytes;
    write({{"op", "end"}, {"reason", why}, {"t_us", nowUs() - startUs_}});
    close(std::exchange(descriptor_, -1));
}

}  // namespace caustream::session
