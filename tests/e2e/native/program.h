// Other programs, run by a test: to their end, or beside it.
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace caustream::e2e {

using Environment = std::map<std::string, std::string>;  // on top of the test's own

struct Result {
    int exitCode = -1;  // negative: the signal that killed it
    std::string out, err;
};

Result run(const std::string& program, const std::vector<std::string>& arguments, const Environment& environment = {});

// Runs until the end of its scope, then gets SIGTERM.
class Background {
 public:
    Background(const std::string& program, const std::vector<std::string>& arguments,
               const Environment& environment = {});
    ~Background();
    Background(const Background&) = delete;

    // The first line of its standard output; empty when it ended without one.
    std::string firstLine();
    pid_t pid() const { return pid_; }
    int stop(int signal);  // the exit code, as in Result
    // It ended by itself within half a minute.
    bool ends();

 private:
    pid_t pid_ = 0;
    int out_ = -1;
};

// A caustream-server; `options` go to it.
class Server {
 public:
    explicit Server(std::vector<std::string> options = {"--port", "0"});
    const std::string& url() const { return url_; }
    std::string port() const;
    pid_t pid() const { return process_.pid(); }
    void kill() { process_.stop(9); }

 private:
    Background process_;
    std::string url_;
};

// A folder that goes with the test.
struct TemporaryFolder {
    TemporaryFolder();
    ~TemporaryFolder();
    std::filesystem::path path;
    std::string operator/(const std::string& name) const { return path / name; }
};

}  // namespace caustream::e2e
