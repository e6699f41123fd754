// A WebSocket client on a thread of its own that connects again by itself. Knows nothing of what the messages say.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "client/connection/address.h"

namespace caustream::connection {

// All are called on the socket's thread.
struct SocketHandlers {
    std::function<void()> opened;
    // Also after an attempt that failed. The code is the server's; kBadCertificate; 0: no connection, or it broke.
    std::function<void(int closeCode, const std::string& why)> closed;
    std::function<void(std::string_view)> text;
    std::function<void(std::span<const std::uint8_t>)> binary;
    std::function<void()> tick;  // about ten times a second
};

class Socket {
 public:
    // `caFile`: PEM, what a server's certificate is checked against instead of the system's; empty: the system's.
    Socket(Address address, const std::string& caFile, SocketHandlers handlers);
    void start();
    ~Socket();  // closes, joins the thread
    Socket(const Socket&) = delete;

    // Any thread. What is sent while there is no connection is dropped: the owner says it again in `opened`.
    void sendText(std::string_view message);
    void sendBinary(std::span<const std::uint8_t> head, std::span<const std::uint8_t> payload = {});

    // Runs `work` soon, on the socket's thread. Any thread.
    void post(std::function<void()> work);

    // Closes this connection with a code; a new one is made. The socket's thread.
    void close(int code, const std::string& why);
    // The next attempt waits this long instead of what the backoff says; negative: there will be none until this is
    // called again. The socket's thread.
    void reconnectIn(int ms);
    // The server took us in: the next loss begins with the shortest wait again. The socket's thread.
    void settled();
    // Until the next attempt, ms; negative: there will be none. The socket's thread.
    int waitMs() const;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace caustream::connection
