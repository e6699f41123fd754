#include "program.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <utility>

namespace caustream::e2e {
namespace {

// `out` and `err`: where the program writes; -1: where we do.
pid_t start(const std::string& program, const std::vector<std::string>& arguments, const Environment& environment,
            int out, int err) {
    std::vector<char*> argv = {const_cast<char*>(program.c_str())};
    for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    const pid_t pid = fork();
    if (pid < 0) throw std::runtime_error("cannot start " + program);
    if (pid > 0) return pid;
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    if (out >= 0) dup2(out, STDOUT_FILENO);
    if (err >= 0) dup2(err, STDERR_FILENO);
    execvp(argv[0], argv.data());
    _exit(127);
}

int waitFor(pid_t pid) {
    int status = 0;
    waitpid(pid, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

std::array<int, 2> makePipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
    return ends;
}

}  // namespace

Result run(const std::string& program, const std::vector<std::string>& arguments, const Environment& environment) {
    const auto out = makePipe(), err = makePipe();
    const pid_t pid = start(program, arguments, environment, out[1], err[1]);
    close(out[1]);
    close(err[1]);
    Result result;
    std::array<pollfd, 2> ends{{{out[0], POLLIN, 0}, {err[0], POLLIN, 0}}};
    while (ends[0].fd >= 0 || ends[1].fd >= 0) {
        poll(ends.data(), ends.size(), -1);
        for (std::size_t i = 0; i < 2; ++i) {
            if (ends[i].fd < 0 || ends[i].revents == 0) continue;
            std::array<char, 4096> buffer{};
            const ssize_t size = read(ends[i].fd, buffer.data(), buffer.size());
            if (size <= 0)
                ends[i].fd = -1;
            else
                (i == 0 ? result.out : result.err).append(buffer.data(), static_cast<std::size_t>(size));
        }
    }
    close(out[0]);
    close(err[0]);
    result.exitCode = waitFor(pid);
    return result;
}

Background::Background(const std::string& program, const std::vector<std::string>& arguments,
                       const Environment& environment) {
    const auto out = makePipe();
    pid_ = start(program, arguments, environment, out[1], -1);
    close(out[1]);
    out_ = out[0];
}

Background::~Background() {
    stop(SIGTERM);
    close(out_);
}

std::string Background::firstLine() {
    std::string line;
    char c = 0;
    while (read(out_, &c, 1) == 1 && c != '\n') line += c;
    return line;
}

bool Background::ends() {
    for (int i = 0; i < 300; ++i) {
        int status = 0;
        if (waitpid(pid_, &status, WNOHANG) == pid_) {
            pid_ = 0;
            return WIFEXITED(status) && WEXITSTATUS(status) == 0;
        }
        usleep(100'000);
    }
    return false;
}

int Background::stop(int signal) {
    if (pid_ == 0) return 0;
    kill(pid_, signal);
    return waitFor(std::exchange(pid_, 0));
}

Server::Server(std::vector<std::string> options)
    : process_(CAUSTREAM_BIN "/caustream-server", [&] {
          options.insert(options.end(), {"--gpu", "software", "--log-level", "error"});
          return options;
      }()) {
    const std::string line = process_.firstLine();
    if (!line.starts_with("ready ")) throw std::runtime_error("the server did not start");
    url_ = line.substr(6);
}

std::string Server::port() const {
    const auto colon = url_.rfind(':');
    return url_.substr(colon + 1, url_.find('/', colon) - colon - 1);
}

TemporaryFolder::TemporaryFolder() {
    std::string name = std::filesystem::temp_directory_path() / "caustream-test-XXXXXX";
    if (!mkdtemp(name.data())) throw std::runtime_error("cannot make a folder in " + name);
    path = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
}

}  // namespace caustream::e2e
