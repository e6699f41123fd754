// The running server: owns the port, the threads and the viewers. Frames can be asked for once the constructor returns.
#pragma once
#include <atomic>
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
    ~Service() override;  // closes connections that are left, ends the threads

    int port() const { return server_.port(); }

    // No new viewers; those that are there hear why and leave once they have what is on its way to them, or after so many
    // seconds. ended() from then on. Any thread; the first call counts.
    void drain(protocol::Goaway::Reason reason, int seconds);
    bool ended() const { return ended_; }

    // Why the server cannot go on: a frame that takes for ever, a lost GPU, a network thread that stands still. Any thread.
    std::optional<std::string> failure() const;
    // Unhealthy from now on; every viewer is told. Any thread.
    void fail(const std::string& why);

    bool drawing() const { return renderer_->busySinceUs() != 0; }

   private:
    // The network thread calls these.
    void opened(net::Connection& connection) override;
    void received(net::Connection& connection, std::string_view message, bool binary) override;
    std::optional<session::Outgoing> next(net::Connection& connection) override;
    void closed(net::Connection& connection) override;
    void tick() override;
    net::HttpResponse http(const net::HttpRequest& request) override;

    void deliver(Delivery&& delivery);  // any thread
    void startDraining(protocol::Goaway::Reason reason, int seconds);
    void sayFarewell(protocol::Goaway::Reason reason);
    void tellFailure(const std::string& why);
    net::HttpResponse health() const;
    std::string metrics() const;

    Config config_;
    Desk desk_;                                            // network thread
    std::map<SessionKey, std::unique_ptr<Viewer>> viewers_;  // network thread
    std::uint64_t sentFrames_ = 0, sentBytes_ = 0, replaced_ = 0, outdated_ = 0;  // of viewers that have gone; network thread
    std::uint64_t farewellUs_ = 0, endUs_ = 0;             // of draining: when viewers are told, when it is over; network thread
    std::uint64_t laggedUs_ = 0;                           // when a round was last far too late; network thread

    std::atomic<std::uint64_t> networkBeatUs_;             // the network thread's last round
    std::atomic<bool> draining_{false}, failed_{false}, ended_{false};

    // In this order: the socket outlives whoever posts to it.
    net::WebSocketServer server_;
    std::optional<session::AssetDirectory> assets_;
    session::LoadPool loader_;
    std::unique_ptr<RenderThread> renderer_;
    std::thread network_;
};

}  // namespace caustream
