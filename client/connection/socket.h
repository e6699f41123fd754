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
    std::function<void(int closeCode, const std::string& why)> closed;  // also after an attempt that failed
    std::function<void(std::string_view)> text;
    std::function<void(std::span<const std::uint8_t>)> binary;
    std::function<void()> tick;  // about ten times a second
};

class Socket {
 public:
    Socket(Address address, SocketHandlers handlers);
    void start();
    ~Socket();  // closes, joins the thread
    Socket(const Socket&) = delete;

    // Any thread. What is sent while there is no connection is dropped: the owner says it again in `opened`.
    void sendText(std::string_view message);
    void sendBinary(std::span<const std::uint8_t> head, std::span<const std::uint8_t> payload = {});

    // Runs `work` soon, on the socket's thread. Any thread.
    void post(std::function<void()> work);

    // Closes this connection with a code; a new one is made unless `again` is false. The socket's thread.
    void close(int code, const std::string& why, bool again);
    // The next attempt waits this long instead of what the backoff says. The socket's thread.
    void reconnectIn(int ms);

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace caustream::connection
