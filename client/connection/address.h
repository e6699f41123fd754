// Where a server is: "http://host:port" as its ready line says it, or "ws://host:port/ws"; https and wss where it has a
// certificate.
#pragma once
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace caustream::connection {

inline constexpr const char* kDefaultUrl = "http://127.0.0.1:9720";  // of a server that was told nothing

struct Address {
    std::string host;
    int port = 0;              // 1..65535
    std::string path;          // with its query, "/ws?srv=a1"
    bool tls = false;
    std::string text() const;  // "ws://host:port/path", "wss://..." with TLS
};

// The same place without ?srv=: any server behind a load balancer.
Address anyServer(Address address);

// Port 80, or 443 with TLS, when none is said, path "/ws" when none or "/" is said. The error is a sentence.
tl::expected<Address, std::string> parseAddress(std::string_view url);

}  // namespace caustream::connection
