#include "load_balancer.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "../raw_client.h"

namespace caustream::e2e {
namespace {

// One that was free a moment ago.
int freePort() {
    const int probe = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{.sin_family = AF_INET, .sin_addr = {htonl(INADDR_LOOPBACK)}};
    socklen_t size = sizeof address;
    bind(probe, reinterpret_cast<const sockaddr*>(&address), size);
    getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size);
    close(probe);
    return ntohs(address.sin_port);
}

void replace(std::string& text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) {
        throw std::runtime_error("deploy/haproxy.cfg no longer holds \"" + from + "\"");
    }
    text.replace(at, from.size(), to);
}

bool listens(int port) {
    try {
        close(connectTo(port));
        return true;
    } catch (const std::runtime_error&) {
        return false;
    }
}

}  // namespace

LoadBalancer::LoadBalancer(const std::array<int, 3>& serverPorts) : port_(freePort()) {
    std::stringstream text;
    text << std::ifstream(CAUSTREAM_DEPLOY "/haproxy.cfg").rdbuf();
    std::string config = text.str();
    replace(config, "bind :8080", "bind 127.0.0.1:" + std::to_string(port_));
    for (std::size_t i = 0; i < serverPorts.size(); ++i) {
        replace(config, "192.0.2.1" + std::to_string(i + 1) + ":9720", "127.0.0.1:" + std::to_string(serverPorts[i]));
    }
    file_ = (std::filesystem::temp_directory_path() / ("caustream-haproxy-" + std::to_string(getpid()) + ".cfg")).string();
    std::ofstream(file_) << config;
    pid_ = fork();
    if (pid_ == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
        execlp("haproxy", "haproxy", "-q", "-db", "-f", file_.c_str(), nullptr);
        execl("/usr/sbin/haproxy", "haproxy", "-q", "-db", "-f", file_.c_str(), nullptr);
        _exit(127);
    }
    for (int i = 0; i < 300 && !listens(port_); ++i) {
        if (waitpid(pid_, nullptr, WNOHANG) == pid_) {
            pid_ = 0;
            throw std::runtime_error("HAProxy does not start; scripts/setup.sh --tests installs it");
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
}

LoadBalancer::~LoadBalancer() {
    if (pid_ > 0) {
        kill(pid_, SIGKILL);
        waitpid(pid_, nullptr, 0);
    }
    std::filesystem::remove(file_);
}

}  // namespace caustream::e2e
