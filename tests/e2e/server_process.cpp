#include "server_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <stdexcept>
#include <utility>

namespace caustream::e2e {
namespace {

struct Started {
    pid_t pid;
    int out, err;
};

Started start(const std::vector<std::string>& arguments) {
    std::array<int, 2> out{}, err{};
    if (pipe2(out.data(), O_CLOEXEC) != 0 || pipe2(err.data(), O_CLOEXEC) != 0) {
        throw std::runtime_error("pipe");
    }
    std::vector<char*> argv = {const_cast<char*>(CAUSTREAM_SERVER)};
    for (const std::string& argument : arguments) {
        argv.push_back(const_cast<char*>(argument.c_str()));
    }
    argv.push_back(nullptr);
    const pid_t pid = fork();
    if (pid == 0) {
        dup2(out[1], STDOUT_FILENO);
        dup2(err[1], STDERR_FILENO);
        execv(CAUSTREAM_SERVER, argv.data());
        _exit(127);
    }
    close(out[1]);
    close(err[1]);
    return {pid, out[0], err[0]};
}

// Appends what there is; false once both ends are closed.
bool drain(int out, int err, std::string& outText, std::string& errText, bool untilLine) {
    bool outOpen = true, errOpen = true;
    while (outOpen || errOpen) {
        std::array<pollfd, 2> ends = {{{outOpen ? out : -1, POLLIN, 0}, {errOpen ? err : -1, POLLIN, 0}}};
        if (poll(ends.data(), ends.size(), 60'000) <= 0) {
            return true;
        }
        for (std::size_t i = 0; i < 2; ++i) {
            if (ends[i].revents == 0) {
                continue;
            }
            std::array<char, 4096> buffer{};
            const ssize_t size = read(ends[i].fd, buffer.data(), buffer.size());
            if (size <= 0) {
                (i == 0 ? outOpen : errOpen) = false;
            } else {
                (i == 0 ? outText : errText).append(buffer.data(), static_cast<std::size_t>(size));
            }
        }
        if (untilLine && outText.find('\n') != std::string::npos) {
            return true;
        }
    }
    return false;
}

int exitCodeOf(pid_t pid) {
    int status = 0;
    waitpid(pid, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

}  // namespace

Ended runServer(const std::vector<std::string>& arguments) {
    const Started started = start(arguments);
    Ended ended;
    if (drain(started.out, started.err, ended.out, ended.err, false)) {
        kill(started.pid, SIGKILL);
    }
    ended.exitCode = exitCodeOf(started.pid);
    close(started.out);
    close(started.err);
    return ended;
}

ServerProcess::ServerProcess(std::vector<std::string> arguments) {
    if (std::ranges::find(arguments, "--port") == arguments.end()) {
        arguments.insert(arguments.begin(), {"--port", "0"});
    }
    const Started started = start(arguments);
    pid_ = started.pid;
    out_ = started.out;
    err_ = started.err;
    drain(out_, err_, ready_, errText_, true);
    const std::size_t colon = ready_.rfind(':');
    if (!ready_.starts_with("ready http") || colon == std::string::npos) {
        const Ended ended = stop();
        throw std::runtime_error("the server did not start: " + ended.out + ended.err);
    }
    port_ = std::stoi(ready_.substr(colon + 1));
}

ServerProcess::~ServerProcess() { stop(); }

Ended ServerProcess::stop() {
    if (pid_ != 0) {
        kill(pid_, SIGTERM);
    }
    return wait();
}

Ended ServerProcess::wait() {
    if (pid_ == 0) {
        return {};
    }
    Ended ended{.out = ready_, .err = errText_};
    if (drain(out_, err_, ended.out, ended.err, false)) {
        kill(pid_, SIGKILL);
    }
    ended.exitCode = exitCodeOf(std::exchange(pid_, 0));
    close(out_);
    close(err_);
    return ended;
}

}  // namespace caustream::e2e
