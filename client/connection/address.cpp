#include "client/connection/address.h"

#include <algorithm>
#include <charconv>

namespace caustream::connection {

std::string Address::text() const {
    const bool v6 = host.find(':') != std::string::npos;
    return (tls ? "wss://" : "ws://") + (v6 ? "[" + host + "]" : host) + ":" + std::to_string(port) + path;
}

Address anyServer(Address address) {
    std::string kept;
    const std::size_t query = address.path.find('?');
    std::string_view rest = query == std::string::npos ? std::string_view{} : std::string_view(address.path).substr(query + 1);
    while (!rest.empty()) {
        const std::string_view field = rest.substr(0, rest.find('&'));
        rest.remove_prefix(std::min(rest.size(), field.size() + 1));
        if (!field.starts_with("srv=")) kept.append(1, kept.empty() ? '?' : '&').append(field);
    }
    address.path = address.path.substr(0, query) + kept;
    return address;
}

tl::expected<Address, std::string> parseAddress(std::string_view url) {
    const std::string shown(url);
    const auto fail = [&](const std::string& why) {
        return tl::make_unexpected("address \"" + shown + "\": " + why +
                                   "; write http://host:port or ws://host:port/ws, https or wss with TLS");
    };
    Address address;
    if (const auto scheme = url.find("://"); scheme != url.npos) {
        const auto name = url.substr(0, scheme);
        address.tls = name == "https" || name == "wss";
        if (!address.tls && name != "http" && name != "ws") return fail("unknown scheme " + std::string(name));
        url.remove_prefix(scheme + 3);
    }

    const auto slash = url.find_first_of("/?");
    std::string_view authority = url.substr(0, slash);
    std::string_view path = slash == url.npos ? std::string_view{} : url.substr(slash);
    if (path.empty() || path == "/") {
        address.path = "/ws";
    } else {
        if (path.starts_with("/?")) path.remove_prefix(1);
        address.path = path.front() == '?' ? "/ws" + std::string(path) : std::string(path);
    }

    // An IPv6 host stands in brackets, so that its colons are not the port's.
    std::string_view port;
    if (authority.starts_with('[')) {
        const auto close = authority.find(']');
        if (close == authority.npos) return fail("the [ of the host is not closed");
        address.host = authority.substr(1, close - 1);
        port = authority.substr(close + 1);
        if (!port.empty() && !port.starts_with(':')) return fail("a port follows the host after a colon");
    } else {
        const auto colon = authority.find(':');
        address.host = authority.substr(0, colon);
        if (colon != authority.npos) port = authority.substr(colon);
    }
    if (address.host.empty()) return fail("no host");

    address.port = address.tls ? 443 : 80;
    if (!port.empty()) {
        port.remove_prefix(1);
        const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
        if (error != std::errc{} || end != port.data() + port.size() || address.port < 1 || address.port > 65535)
            return fail("the port must be a number from 1 to 65535");
    }
    return address;
}

}  // namespace caustream::connection
