// The one port: a WebSocket endpoint at /ws and a few HTTP pages, on libwebsockets. Everything here but post() belongs to
// the network thread, which is the one inside run().
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "net/http.h"
#include "net/server_options.h"
#include "net/socket_table.h"
#include "session/outbox.h"

struct lws;
struct lws_context;

namespace caustream::net {

class Connection;

// What the owner of the port does with what arrives. Called on the network thread.
class Endpoint {
   public:
    virtual ~Endpoint() = default;
    virtual void opened(Connection& connection) = 0;
    virtual void received(Connection& connection, std::string_view message, bool binary) = 0;
    // The socket takes one message; nothing: it has all there is. More is asked for until then.
    virtual std::optional<session::Outgoing> next(Connection& connection) = 0;
    virtual void closed(Connection& connection) = 0;
    virtual void tick() = 0;  // four times a second
    virtual HttpResponse http(const HttpRequest& request) = 0;
};

// One WebSocket. Lives from opened() to closed().
class Connection {
   public:
    Connection(lws* socket, std::uint64_t id) : socket_(socket), id_(id) {}

    std::uint64_t id() const { return id_; }
    void requestWrite();

    // Sends what next() still gives, then closes; what arrives from now on is dropped. The first call wins.
    void close(std::uint16_t code, std::string reason);
    bool closing() const { return closeCode_ != 0; }

   private:
    friend class WebSocketServer;
    lws* socket_;
    std::uint64_t id_;
    std::string partial_;      // of a message that arrives in pieces
    std::size_t pieces_ = 0;   // of that message, so far
    std::uint16_t closeCode_ = 0;
    bool saidGoodbye_ = false;
    std::string closeReason_;
    std::uint64_t closeByUs_ = 0;   // the socket goes then, whatever the far side does
    std::size_t dropped_ = 0;       // bytes that came after close()
    bool waiting_ = false;          // for the socket to take something
    std::uint64_t ackedBytes_ = 0;  // by the far side's TCP,
    std::uint64_t movedUs_ = 0;     // and when that last grew, or nothing waited
};

// What the port had to do about others' sockets, since the start.
struct SocketCounts {
    std::size_t open = 0;
    std::uint64_t refused = 0;   // too many, in all or from one address
    std::uint64_t slow = 0;      // closed: a request's head or an answer took too long
    std::uint64_t stuck = 0;     // closed: took nothing while something waited
    std::uint64_t flooding = 0;  // closed: went on sending after it was told off
};

class WebSocketServer {
   public:
    // Binds; throws Error when the port is taken, the address is not this machine's or the certificate does not load.
    WebSocketServer(const ServerOptions& options, Endpoint& endpoint);
    ~WebSocketServer();

    int port() const { return port_; }
    SocketCounts counts() const;  // network thread
    void run();   // until stop()
    void stop();  // any thread

    // Runs `task` on the network thread, soon. Any thread.
    void post(std::function<void()> task);

    struct Callbacks;  // libwebsockets calls into it

   private:
    void runPosted();
    void tick();
    void endLate(std::uint64_t nowUs);
    void drop(Connection& connection, std::size_t bytes);
    bool receive(Connection& connection, std::string_view piece, bool binary, bool first, bool final, std::size_t remaining);
    int write(Connection& connection);
    int sayGoodbye(Connection& connection);

    ServerOptions options_;
    Endpoint& endpoint_;
    lws_context* context_ = nullptr;
    int port_ = 0;
    std::uint64_t nextConnection_ = 1;
    SocketTable sockets_;
    std::set<Connection*> connections_;
    SocketCounts counts_;

    std::mutex mutex_;
    std::vector<std::function<void()>> posted_;  // guarded by mutex_
    bool stopping_ = false;                      // guarded by mutex_

    struct Timer;
    std::unique_ptr<Timer> timer_;
};

}  // namespace caustream::net
