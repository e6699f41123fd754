// A WebSocketServer on a free port, with an endpoint that sends what a test wants and counts what comes.
#pragma once
#include <atomic>
#include <functional>
#include <thread>

#include "net/websocket_server.h"

namespace caustream::e2e {

class LonePort final : private net::Endpoint {
   public:
    explicit LonePort(net::ServerOptions options = {});
    ~LonePort() override;

    int port() const { return server_.port(); }
    net::SocketCounts counts();

    // True once `condition` holds; false after 30 s, which says how long to wait and not how fast anything is.
    static bool eventually(const std::function<bool()>& condition);

    std::atomic<int> openings{0}, closings{0}, messages{0};
    std::atomic<int> mostMessages{1 << 30};    // the next is one too many: its connection is closed with 4429
    std::atomic<std::size_t> messageBytes{0};  // of the messages that go to every viewer without end; 0: none

   private:
    void opened(net::Connection& connection) override;
    void received(net::Connection& connection, std::string_view message, bool binary) override;
    std::optional<session::Outgoing> next(net::Connection& connection) override;
    void closed(net::Connection&) override { ++closings; }
    void tick() override {}
    net::HttpResponse http(const net::HttpRequest& request) override { return {.body = request.path}; }

    net::WebSocketServer server_;
    std::thread thread_;
};

}  // namespace caustream::e2e
