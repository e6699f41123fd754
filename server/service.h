// The running server: owns the port, the threads and the viewers. Frames can be asked for once the constructor returns.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "config.h"
#include "viewer.h"

namespace caustream {

class Service final : private net::Endpoint {
   public:
    // Throws Error: the port is taken, no GPU, a shader does not compile.
    explicit Service(const Config& config);
    ~Service() override;  // tells the viewers, closes their connections, ends the threads

    int port() const { return server_.port(); }

   private:
    // The network thread calls these.
    void opened(net::Connection& connection) override;
    void received(net::Connection& connection, std::string_view message, bool binary) override;
    std::optional<session::Outgoing> next(net::Connection& connection) override;
    void closed(net::Connection& connection) override;
    void tick() override;
    net::HttpResponse http(const net::HttpRequest& request) override;

    void deliver(Delivery&& delivery);  // any thread
    void drain();
    std::string metrics() const;
    bool healthy() const;

    Config config_;
    Desk desk_;                                            // network thread
    std::map<SessionKey, std::unique_ptr<Viewer>> viewers_;  // network thread
    std::uint64_t sentFrames_ = 0, sentBytes_ = 0, dropped_ = 0;  // of viewers that have gone; network thread
    std::uint64_t drainSinceUs_ = 0;                       // network thread

    // In this order: the socket outlives whoever posts to it.
    net::WebSocketServer server_;
    std::optional<session::AssetDirectory> assets_;
    session::LoadPool loader_;
    std::unique_ptr<RenderThread> renderer_;
    std::thread network_;
};

}  // namespace caustream
