#include "lone_port.h"

#include <chrono>
#include <future>

namespace caustream::e2e {

using namespace std::chrono_literals;

LonePort::LonePort(net::ServerOptions options) : server_(options, *this), thread_([this] { server_.run(); }) {}

LonePort::~LonePort() {
    server_.stop();
    thread_.join();
}

net::SocketCounts LonePort::counts() {
    std::promise<net::SocketCounts> counts;
    server_.post([&] { counts.set_value(server_.counts()); });
    return counts.get_future().get();
}

bool LonePort::eventually(const std::function<bool()>& condition) {
    for (const auto last = std::chrono::steady_clock::now() + 30s; std::chrono::steady_clock::now() < last;) {
        if (condition()) {
            return true;
        }
        std::this_thread::sleep_for(10ms);
    }
    return false;
}

void LonePort::opened(net::Connection& connection) {
    ++openings;
    connection.requestWrite();
}

void LonePort::received(net::Connection& connection, std::string_view, bool) {
    if (++messages > mostMessages) {
        connection.close(4429, "too many");
    }
}

std::optional<session::Outgoing> LonePort::next(net::Connection& connection) {
    if (messageBytes == 0 || connection.closing()) {
        return std::nullopt;
    }
    return session::Outgoing{stream::WireBuffer(messageBytes), true};
}

}  // namespace caustream::e2e
