#include "bench/stream/relay.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "client/connection/connection.h"
#include "error.h"

namespace caustream::bench {
namespace {

constexpr int kBufferBytes = 16 << 10;   // the kernel doubles it, and counts its own bookkeeping in
constexpr int kSegmentBytes = 1448;      // as on Ethernet: loopback's 64 KiB would not fit into such buffers
constexpr std::size_t kMaxConnections = 32;

std::uint64_t nowUs() { return connection::nowUs(); }

void option(int socket, int level, int name, int value) { setsockopt(socket, level, name, &value, sizeof value); }

// Before connect() or listen(): the window is agreed upon there.
int openSocket() {
    const int descriptor = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (descriptor < 0) throw Error(std::string("relay; no socket: ") + std::strerror(errno) + "; close other programs");
    option(descriptor, SOL_SOCKET, SO_SNDBUF, kBufferBytes);
    option(descriptor, SOL_SOCKET, SO_RCVBUF, kBufferBytes);
    option(descriptor, IPPROTO_TCP, TCP_MAXSEG, kSegmentBytes);
    option(descriptor, IPPROTO_TCP, TCP_NODELAY, 1);
    return descriptor;
}

sockaddr_in loopback(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
}

// One direction between two sockets.
struct Pipe {
    int from, to;
    Link link;
    bool ended = false;    // nothing more comes
    bool broken = false;   // it cannot be passed on

    bool over() { return broken || (ended && link.arrived(~std::uint64_t{0}).empty()); }

    void read() {
        std::array<char, 64 << 10> buffer;
        while (!ended) {
            const std::size_t room = std::min(buffer.size(), link.room(nowUs()));
            if (room == 0) return;
            const ssize_t size = recv(from, buffer.data(), room, 0);
            if (size < 0 && (errno == EAGAIN || errno == EINTR)) return;
            if (size <= 0) ended = true;
            else link.enter({buffer.data(), static_cast<std::size_t>(size)}, nowUs());
        }
    }
    void write() {
        while (!broken) {
            const std::string_view bytes = link.arrived(nowUs());
            if (bytes.empty()) return;
            const ssize_t size = send(to, bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (size < 0 && (errno == EAGAIN || errno == EINTR)) return;
            if (size <= 0) broken = true;
            else link.leave(static_cast<std::size_t>(size));
        }
    }
};

}  // namespace

struct Relay::Connection {
    int client, server;
    Pipe toClient{server, client, {}}, toServer{client, server, {}};

    Connection(int clientSocket, int serverSocket) : client(clientSocket), server(serverSocket) {}
    ~Connection() {
        close(client);
        close(server);
    }
    void reshape(const NetworkShape& shape) {
        toClient.link.reshape(shape.toClient, nowUs());
        toServer.link.reshape(shape.toServer, nowUs());
    }
    // What a socket is waited for; not at all, lest a hung-up one wakes us all the time.
    static pollfd wanted(int socket, Pipe& in, Pipe& out) {
        const bool reads = !in.ended && in.link.room(nowUs()) > 0, writes = !out.link.arrived(nowUs()).empty();
        return {reads || writes ? socket : -1, static_cast<short>((reads ? POLLIN : 0) | (writes ? POLLOUT : 0)), 0};
    }
};

Relay::Relay(int serverPort, NetworkShape shape) : serverPort_(serverPort), shape_(shape) {
    listener_ = openSocket();
    sockaddr_in address = loopback(0);
    socklen_t size = sizeof address;
    if (bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 || listen(listener_, 16) != 0 ||
        getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
        const int problem = errno;
        close(listener_);
        throw Error(std::string("relay; cannot listen on loopback: ") + std::strerror(problem) + "; is networking set up?");
    }
    port_ = ntohs(address.sin_port);
    event_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    thread_ = std::thread([this] { run(); });
}

Relay::~Relay() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    wake();
    thread_.join();
    connections_.clear();
    close(listener_);
    close(event_);
}

void Relay::reshape(NetworkShape shape) {
    {
        const std::lock_guard lock(mutex_);
        shape_ = shape;
        reshaped_ = true;
    }
    wake();
}

void Relay::wake() {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(event_, &one, sizeof one);   // fails only when it is awake already
}

void Relay::accept() {
    const int client = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (client < 0) return;
    const int server = openSocket();
    const sockaddr_in address = loopback(serverPort_);
    if (connections_.size() >= kMaxConnections || connect(server, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        close(client);
        close(server);
        return;
    }
    fcntl(server, F_SETFL, O_NONBLOCK);
    option(client, IPPROTO_TCP, TCP_NODELAY, 1);
    connections_.push_back(std::make_unique<Connection>(client, server));
    const std::lock_guard lock(mutex_);
    connections_.back()->reshape(shape_);
}

void Relay::run() {
    std::vector<pollfd> waited;
    while (true) {
        // What to wait for, and how long at most
        waited = {{event_, POLLIN, 0}, {listener_, POLLIN, 0}};
        std::uint64_t next = 0;
        for (const auto& connection : connections_) {
            Pipe &down = connection->toClient, &up = connection->toServer;
            waited.push_back(Connection::wanted(connection->client, up, down));
            waited.push_back(Connection::wanted(connection->server, down, up));
            for (Pipe* pipe : {&down, &up}) {
                const std::uint64_t own = pipe->link.nextUs(nowUs());
                if (own != 0) next = next == 0 ? own : std::min(next, own);
            }
        }
        timespec wait{1, 0};
        if (next != 0) {
            const std::uint64_t now = nowUs(), us = next > now ? next - now : 0;
            wait = {static_cast<time_t>(us / 1'000'000), static_cast<long>(us % 1'000'000) * 1000};
        }
        ppoll(waited.data(), waited.size(), &wait, nullptr);

        if (waited[0].revents != 0) {
            std::uint64_t count = 0;
            [[maybe_unused]] const ssize_t size = ::read(event_, &count, sizeof count);
            const std::lock_guard lock(mutex_);
            if (stopping_) return;
            if (reshaped_) {
                for (const auto& connection : connections_) connection->reshape(shape_);
            }
            reshaped_ = false;
        }
        if (waited[1].revents != 0) accept();
        std::uint64_t bytes = 0;
        for (const auto& connection : connections_) {
            for (Pipe* pipe : {&connection->toClient, &connection->toServer}) {
                const std::uint64_t before = pipe->link.passed();
                pipe->read();
                pipe->write();
                if (pipe == &connection->toClient) bytes += pipe->link.passed() - before;
            }
        }
        bytesToClients_ += bytes;
        std::erase_if(connections_, [](const auto& connection) { return connection->toClient.over() || connection->toServer.over(); });
    }
}

}  // namespace caustream::bench
