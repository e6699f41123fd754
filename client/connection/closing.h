// What the end of a connection means to whoever was connected.
#pragma once
#include <string>

namespace caustream::connection {

// RFC 6455: never on the wire, but what a client may say of a certificate that it does not trust.
inline constexpr int kBadCertificate = 1015;

struct Closing {
    bool retry = true;  // false: it takes a person
    std::string why;    // without a full stop
};

// `code`: the server's close code, kBadCertificate, or 0 when no connection came about or it broke. `reason`: what came
// with it.
Closing closingOf(int code, const std::string& reason);

}  // namespace caustream::connection
