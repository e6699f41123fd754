// deploy/haproxy.cfg on this machine: HAProxy on a free port, in front of servers a, b and c.
#pragma once
#include <sys/types.h>

#include <array>
#include <string>

namespace caustream::e2e {

class LoadBalancer {
   public:
    // Throws std::runtime_error: HAProxy is missing (scripts/setup.sh --tests), or refuses the file.
    explicit LoadBalancer(const std::array<int, 3>& serverPorts);
    ~LoadBalancer();
    LoadBalancer(const LoadBalancer&) = delete;
    LoadBalancer& operator=(const LoadBalancer&) = delete;

    int port() const { return port_; }

   private:
    int port_ = 0;
    pid_t pid_ = 0;
    std::string file_;
};

}  // namespace caustream::e2e
