// Where a WebSocketServer listens, to whom, and how patiently.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace caustream::net {

struct ServerOptions {
    std::string bind = "127.0.0.1";
    int port = 0;  // 0: any free one
    std::size_t maxTextBytes = 64u << 10, maxBinaryBytes = 1u << 20;
    int pingS = 15, deadS = 30;
    std::string tlsCert, tlsKey;               // PEM files; empty: plain http
    std::vector<std::string> allowedOrigins;   // of pages besides our own
    std::size_t maxConnections = 256, maxPerAddress = 64;  // sockets, those of plain HTTP too
    bool checkHost = true;  // only this machine's own names in Host: a page elsewhere cannot rebind its name to us
};

}  // namespace caustream::net
