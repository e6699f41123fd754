#include "net/websocket_server.h"

#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "error.h"
#include "log.h"
#include "net/admission.h"
#include "net/http_exchange.h"
#include "net/listening.h"
#include "protocol/messages.h"
#include "session/clock.h"

static_assert(caustream::stream::kSocketHeadroom >= LWS_PRE, "libwebsockets writes its framing before the payload");

namespace caustream::net {
namespace {

constexpr std::size_t kReceiveBytes = 64u << 10;  // per read: larger than the default, as chunks are
constexpr std::size_t kSendBytes = 4u << 20;      // per write: below it every frame goes out in one piece, uncopied
constexpr unsigned kOwnDescriptors = 16;          // libwebsockets' own, beside the sockets
constexpr int kTickUs = 250'000;
constexpr int kCloseS = 5;  // for the far side to take what is left before its socket is dropped
constexpr std::size_t kReasonBytes = 120;         // a close frame holds 125 with its code
constexpr std::size_t kMostDropped = 1u << 20;    // bytes read of who was told off, before reading ends
constexpr std::size_t kCostOfDrop = 64;           // bytes that a message counts for there beside its own
// Pieces that a message may come in, and one more for so many of its bytes: fragments and TCP segments, not letters.
constexpr std::size_t kMostPieces = 64, kBytesPerPiece = 256;

void logLine(int level, const char* text) {
    std::string_view line = text;
    while (line.ends_with('\n')) {
        line.remove_suffix(1);
    }
    (level & LLL_ERR ? log::warning("libwebsockets") : log::debug("libwebsockets")).with("message", line);
}

// How much of what was sent the far side's TCP has acknowledged: stands still when nobody reads there.
std::uint64_t ackedBytes(lws* socket) {
    tcp_info info{};
    socklen_t size = sizeof info;
    getsockopt(lws_get_socket_fd(socket), IPPROTO_TCP, TCP_INFO, &info, &size);
    return info.tcpi_bytes_acked;
}

void kill(lws* socket) { lws_set_timeout(socket, PENDING_TIMEOUT_USER_OK, LWS_TO_KILL_ASYNC); }

}  // namespace

struct WebSocketServer::Timer {
    lws_sorted_usec_list_t entry{};
    WebSocketServer* server = nullptr;

    static void fire(lws_sorted_usec_list_t* entry) {
        Timer* timer = reinterpret_cast<Timer*>(entry);  // entry is the first member
        try {
            timer->server->tick();
        } catch (const std::exception& problem) {
            log::error("tick").with("message", problem.what());
        }
        lws_sul_schedule(timer->server->context_, 0, entry, fire, kTickUs);
    }
};

struct WebSocketServer::Callbacks {
    static WebSocketServer& server(lws* socket) {
        return *static_cast<WebSocketServer*>(lws_context_user(lws_get_context(socket)));
    }

    // Nothing may be thrown into the C library; whoever caused it loses the connection.
    template <typename Body>
    static int guarded(Body body) {
        try {
            return body();
        } catch (const std::exception& problem) {
            log::error("network").with("message", problem.what());
            return -1;
        }
    }

    static int going(lws* socket, const Step& step) {
        if (step.result == 0 && step.answered) {
            server(socket).sockets_.answered(socket, session::nowUs());
        }
        return step.result;
    }

    static int http(lws* socket, lws_callback_reasons reason, void* user, void* in, std::size_t length) {
        HttpExchange* exchange = static_cast<HttpExchange*>(user);
        switch (reason) {
            case LWS_CALLBACK_FILTER_NETWORK_CONNECTION:
                return server(socket).sockets_.admits(static_cast<const lws_filter_network_conn_args*>(user)->cli_addr) ? 0 : -1;
            case LWS_CALLBACK_SERVER_NEW_CLIENT_INSTANTIATED:
                return guarded([&] { return server(socket).sockets_.opened(socket, session::nowUs()), 0; });
            case LWS_CALLBACK_WSI_DESTROY: server(socket).sockets_.closed(socket); return 0;
            case LWS_CALLBACK_EVENT_WAIT_CANCELLED:
                return guarded([&] { return server(socket).runPosted(), 0; });
            case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION: return -1;  // "http" is no subprotocol, though libwebsockets knows it
            case LWS_CALLBACK_HTTP_CONFIRM_UPGRADE:
                return guarded([&] { return refuse(socket, server(socket).options_, true); });
            case LWS_CALLBACK_HTTP:
                return guarded([&] {
                    server(socket).sockets_.asked(socket, session::nowUs());
                    if (const int refused = refuse(socket, server(socket).options_, false)) {
                        return refused;
                    }
                    const HttpRequest request{std::string(static_cast<const char*>(in)),
                                              requestHeader(socket, WSI_TOKEN_HTTP_IF_NONE_MATCH)};
                    return going(socket, respond(socket, exchange, server(socket).endpoint_.http(request)));
                });
            case LWS_CALLBACK_HTTP_WRITEABLE:
                return guarded([&] { return going(socket, writeBody(socket, exchange)); });
            case LWS_CALLBACK_CLOSED_HTTP:
            case LWS_CALLBACK_HTTP_DROP_PROTOCOL: endExchange(exchange); return 0;
            default: return lws_callback_http_dummy(socket, reason, user, in, length);
        }
    }

    static int webSocket(lws* socket, lws_callback_reasons reason, void* user, void* in, std::size_t length) {
        Connection** slot = static_cast<Connection**>(user);
        switch (reason) {
            case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
                return guarded([&] {
                    const std::string path = requestHeader(socket, WSI_TOKEN_GET_URI);
                    const bool page = allowsOrigin(socket, server(socket).options_);
                    if (path == "/ws" && page) {
                        return 0;
                    }
                    lws_return_http_status(socket, page ? 404 : 403, page ? "The WebSocket is at /ws" : "Origin not allowed");
                    return -1;
                });
            case LWS_CALLBACK_ESTABLISHED:
                return guarded([&] {
                    WebSocketServer& port = server(socket);
                    *slot = new Connection(socket, port.nextConnection_++);
                    port.connections_.insert(*slot);
                    port.sockets_.upgraded(socket);
                    port.endpoint_.opened(**slot);
                    return 0;
                });
            case LWS_CALLBACK_RECEIVE:
                return guarded([&] {
                    const bool going = server(socket).receive(
                        **slot, {static_cast<const char*>(in), length}, lws_frame_is_binary(socket),
                        lws_is_first_fragment(socket), lws_is_final_fragment(socket), lws_remaining_packet_payload(socket));
                    return going ? 0 : -1;
                });
            case LWS_CALLBACK_SERVER_WRITEABLE: return guarded([&] { return server(socket).write(**slot); });
            case LWS_CALLBACK_WS_PEER_INITIATED_CLOSE: return (*slot)->saidGoodbye_ ? -1 : 0;  // which is its answer, or a goodbye to be answered
            case LWS_CALLBACK_CLOSED:
                if (slot && *slot) {
                    guarded([&] { return server(socket).endpoint_.closed(**slot), 0; });
                    server(socket).connections_.erase(*slot);
                    delete std::exchange(*slot, nullptr);
                }
                return 0;
            case LWS_CALLBACK_EVENT_WAIT_CANCELLED: return 0;  // the HTTP protocol runs what was posted
            default: return lws_callback_http_dummy(socket, reason, user, in, length);
        }
    }
};

void Connection::requestWrite() {
    waiting_ = true;
    lws_callback_on_writable(socket_);
}

void Connection::close(std::uint16_t code, std::string reason) {
    if (closing()) {
        return;
    }
    closeCode_ = code;
    closeReason_ = std::move(reason);
    partial_.clear();
    closeByUs_ = session::nowUs() + kCloseS * 1'000'000ull;
    requestWrite();
}

WebSocketServer::WebSocketServer(const ServerOptions& options, Endpoint& endpoint)
    : options_(options), endpoint_(endpoint), sockets_(options.maxConnections, options.maxPerAddress), timer_(std::make_unique<Timer>()) {
    probePort(options_);
    lws_set_log_level(LLL_ERR | LLL_WARN, logLine);

    // The first protocol is what a socket speaks that names none: plain HTTP.
    static const lws_protocols protocols[] = {
        {"http", Callbacks::http, sizeof(HttpExchange), kReceiveBytes, 0, nullptr, kSendBytes},
        {protocol::kSubprotocol.data(), Callbacks::webSocket, sizeof(Connection*), kReceiveBytes, 0, nullptr, kSendBytes},
        {nullptr, nullptr, 0, 0, 0, nullptr, 0}};
    static const lws_retry_bo_t retry = {.secs_since_valid_ping = static_cast<std::uint16_t>(options_.pingS),
                                         .secs_since_valid_hangup = static_cast<std::uint16_t>(options_.deadS)};
    lws_context_creation_info info{};
    info.iface = options_.bind == "0.0.0.0" ? nullptr : options_.bind.c_str();
    info.port = options_.port;
    info.protocols = protocols;
    info.extensions = nullptr;
    info.alpn = "http/1.1";
    info.pt_serv_buf_size = kReceiveBytes;
    info.max_http_header_data = 16384;
    info.fd_limit_per_thread = static_cast<unsigned>(options_.maxConnections) + kOwnDescriptors;
    info.retry_and_idle_policy = &retry;
    info.user = this;
    info.gid = static_cast<gid_t>(-1);
    info.uid = static_cast<uid_t>(-1);
    info.options = LWS_SERVER_OPTION_VALIDATE_UTF8 | LWS_SERVER_OPTION_DISABLE_IPV6 |
                   LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND | LWS_SERVER_OPTION_EXPLICIT_VHOSTS;
    if (!options_.tlsCert.empty()) {
        addTls(info, options_);
    }
    context_ = lws_create_context(&info);
    lws_vhost* vhost = context_ ? lws_create_vhost(context_, &info) : nullptr;
    if (!vhost) {
        if (context_) {
            lws_context_destroy(context_);
        }
        throw Error("network; libwebsockets cannot listen on " + options_.bind + ":" + std::to_string(options_.port) +
                    (options_.tlsCert.empty() ? "; pass --port 0 for a free port"
                                              : "; check that --tls-cert and --tls-key are PEM files that belong together"));
    }
    port_ = lws_get_vhost_listen_port(vhost);
    timer_->server = this;
    lws_sul_schedule(context_, 0, &timer_->entry, Timer::fire, kTickUs);
}

WebSocketServer::~WebSocketServer() {
    lws_sul_schedule(context_, 0, &timer_->entry, nullptr, LWS_SET_TIMER_USEC_CANCEL);
    lws_context_destroy(context_);
}

void WebSocketServer::run() {
    const auto stopping = [this] {
        const std::lock_guard lock(mutex_);
        return stopping_;
    };
    while (!stopping() && lws_service(context_, 0) >= 0) {
    }
}

void WebSocketServer::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    lws_cancel_service(context_);
}

void WebSocketServer::post(std::function<void()> task) {
    {
        const std::lock_guard lock(mutex_);
        posted_.push_back(std::move(task));
    }
    lws_cancel_service(context_);
}

void WebSocketServer::runPosted() {
    std::vector<std::function<void()>> tasks;
    {
        const std::lock_guard lock(mutex_);
        tasks.swap(posted_);
    }
    for (const auto& task : tasks) {
        Callbacks::guarded([&] { return task(), 0; });
    }
}

void WebSocketServer::tick() {
    endLate(session::nowUs());
    endpoint_.tick();
}

void WebSocketServer::endLate(std::uint64_t nowUs) {
    for (lws* socket : sockets_.overdue(nowUs)) {
        ++counts_.slow;
        kill(socket);
        sockets_.upgraded(socket);  // counted once; it goes in a moment
    }
    for (Connection* connection : connections_) {
        if (connection->closing() && nowUs > connection->closeByUs_) {
            kill(connection->socket_);
            continue;
        }
        const std::uint64_t acked = ackedBytes(connection->socket_);
        if (!connection->waiting_ || std::exchange(connection->ackedBytes_, acked) != acked) {
            connection->movedUs_ = nowUs;
        } else if (nowUs - connection->movedUs_ > static_cast<std::uint64_t>(options_.deadS) * 1'000'000 && !connection->closing()) {
            ++counts_.stuck;
            log::info("stuck").with("connection", connection->id()).with("dead_s", options_.deadS);
            connection->closeByUs_ = nowUs;
            connection->closeCode_ = static_cast<std::uint16_t>(protocol::CloseCode::Timeout);
            kill(connection->socket_);
        }
    }
}

SocketCounts WebSocketServer::counts() const {
    SocketCounts counts = counts_;
    counts.open = sockets_.size();
    counts.refused = sockets_.refused();
    return counts;
}

// Of a connection that was told to go: read and forgotten so that it can still say goodbye, but not for ever.
void WebSocketServer::drop(Connection& connection, std::size_t bytes) {
    const bool flooded = connection.dropped_ > kMostDropped;
    connection.dropped_ += bytes + kCostOfDrop;
    if (!flooded && connection.dropped_ > kMostDropped) {
        ++counts_.flooding;
        lws_rx_flow_control(connection.socket_, 0);
    }
}

bool WebSocketServer::receive(Connection& connection, std::string_view piece, bool binary, bool first, bool final,
                              std::size_t remaining) {
    if (connection.closing()) {
        drop(connection, piece.size());
        return true;
    }
    if (first) {
        connection.partial_.clear();
        connection.pieces_ = 0;
    }
    // Memory follows the bytes that came, but a message that will not fit is refused at its first piece.
    const std::size_t limit = binary ? options_.maxBinaryBytes : options_.maxTextBytes;
    if (connection.partial_.size() + piece.size() + remaining > limit) {
        connection.close(static_cast<std::uint16_t>(protocol::CloseCode::TooLarge),
                         "a message may hold " + std::to_string(limit) + " bytes");
        return true;
    }
    if (++connection.pieces_ > kMostPieces + (connection.partial_.size() + piece.size()) / kBytesPerPiece) {
        connection.close(static_cast<std::uint16_t>(protocol::CloseCode::Busy), "a message in too many pieces");
        return true;
    }
    const bool whole = final && remaining == 0;
    if (whole && connection.partial_.empty()) {
        endpoint_.received(connection, piece, binary);
        return true;
    }
    connection.partial_.append(piece);
    if (whole) {
        const std::string message = std::exchange(connection.partial_, {});
        endpoint_.received(connection, message, binary);
    }
    return true;
}

int WebSocketServer::write(Connection& connection) {
    if (std::optional<session::Outgoing> message = endpoint_.next(connection)) {
        const std::size_t size = message->buffer.size();
        const int sent = lws_write(connection.socket_, message->buffer.data(), size,
                                   message->binary ? LWS_WRITE_BINARY : LWS_WRITE_TEXT);
        if (sent < static_cast<int>(size)) {
            return -1;
        }
        connection.requestWrite();
        return 0;
    }
    connection.waiting_ = false;
    if (connection.closing() && !std::exchange(connection.saidGoodbye_, true)) {
        return sayGoodbye(connection);
    }
    return 0;
}

// A close frame, and the socket stays until the far side has answered it (RFC 6455, 7.1.1): what it sent meanwhile and nobody
// reads would make the kernel reset the connection, and with that the far side forget what it was told. libwebsockets'
// own closing goes as soon as it reads anything.
int WebSocketServer::sayGoodbye(Connection& connection) {
    const std::size_t reasonBytes = std::min(connection.closeReason_.size(), kReasonBytes);
    stream::WireBuffer frame(4 + reasonBytes);
    frame.data()[0] = 0x88;  // final, a close (RFC 6455, 5.2); libwebsockets has no name for writing one
    frame.data()[1] = static_cast<std::uint8_t>(2 + reasonBytes);
    frame.data()[2] = static_cast<std::uint8_t>(connection.closeCode_ >> 8);
    frame.data()[3] = static_cast<std::uint8_t>(connection.closeCode_ & 255);
    connection.closeReason_.copy(reinterpret_cast<char*>(frame.data()) + 4, reasonBytes);
    return lws_write(connection.socket_, frame.data(), frame.size(), LWS_WRITE_RAW) < 0 ? -1 : 0;
}

}  // namespace caustream::net
