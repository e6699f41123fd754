// A caustream-server of a bench's own, as a child process, and what the kernel and the server say of it.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/e2e/native/program.h"

namespace caustream::bench {

class ServerChild {
   public:
    // `program`: the server; `options` go to it, with --port 0. Throws Error when it does not come up.
    ServerChild(const std::string& program, std::vector<std::string> options);

    int port() const { return port_; }
    std::string url() const { return "http://127.0.0.1:" + std::to_string(port_); }

    bool alive() const;                      // it has not ended
    double residentMib() const;              // 0: it has ended
    int descriptors() const;                 // open ones
    std::optional<double> metric(const std::string& name) const;   // of /metrics, "caustream_sessions"; nothing: there is none

   private:
    std::unique_ptr<e2e::Background> process_;
    int port_ = 0;
};

// caustream-server in the folder of the running program.
std::string serverBesideUs();

}  // namespace caustream::bench
