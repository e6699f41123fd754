// A caustream-server of its own for one test: started on a free port, stopped with SIGTERM.
#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

namespace caustream::e2e {

struct Ended {
    int exitCode = -1;   // negative: the signal that killed it
    std::string out, err;
};

// Runs the server until it ends by itself.
Ended runServer(const std::vector<std::string>& arguments);

class ServerProcess {
   public:
    // Waits for the ready line; throws std::runtime_error with what the server said instead.
    explicit ServerProcess(std::vector<std::string> arguments = {});
    ~ServerProcess();

    int port() const { return port_; }
    const std::string& readyLine() const { return ready_; }
    pid_t pid() const { return pid_; }

    // Waits for its end, then everything it said. Killed if it does not end in a minute.
    Ended wait();
    // SIGTERM first.
    Ended stop();

   private:
    pid_t pid_ = 0;
    int out_ = -1, err_ = -1;
    int port_ = 0;
    std::string ready_, errText_;
};

}  // namespace caustream::e2e
