#include "net/admission.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "net/http.h"
#include "net/http_exchange.h"
#include "protocol/messages.h"

namespace caustream::net {
namespace {

// Whether a list of subprotocols, as the header has it, holds ours.
bool namesUs(std::string_view list) {
    while (!list.empty()) {
        const std::size_t comma = std::min(list.find(','), list.size());
        std::string_view name = list.substr(0, comma);
        name.remove_prefix(std::min(name.find_first_not_of(" \t"), name.size()));
        name = name.substr(0, name.find_last_not_of(" \t") + 1);
        if (name == protocol::kSubprotocol) {
            return true;
        }
        list.remove_prefix(std::min(comma + 1, list.size()));
    }
    return false;
}

}  // namespace

int refuse(lws* socket, const ServerOptions& options, bool upgrade) {
    if (!options.tlsCert.empty() && !lws_is_ssl(socket)) {
        lws_return_http_status(socket, 400, "This port speaks TLS: https:// and wss://");
        return -1;
    }
    if (upgrade && requestHeader(socket, WSI_TOKEN_UPGRADE) != "websocket") {  // h2c would open the HTTP/2 code
        lws_return_http_status(socket, 400, "Upgrade must be websocket");
        return -1;
    }
    if (upgrade && !namesUs(requestHeader(socket, WSI_TOKEN_PROTOCOL))) {
        lws_return_http_status(socket, 400, "Sec-WebSocket-Protocol must be caustream.v1");
        return -1;
    }
    if (options.checkHost && !isLocalName(requestHeader(socket, WSI_TOKEN_HOST))) {
        lws_return_http_status(socket, 403, "Host not allowed");
        return -1;
    }
    if (!upgrade && lws_hdr_total_length(socket, WSI_TOKEN_GET_URI) <= 0) {
        lws_return_http_status(socket, 405, "Only GET is answered");
        return -1;
    }
    return 0;
}

bool allowsOrigin(lws* socket, const ServerOptions& options) {
    const std::string origin = requestHeader(socket, WSI_TOKEN_ORIGIN);
    return sameHost(origin, requestHeader(socket, WSI_TOKEN_HOST)) ||
           std::ranges::find(options.allowedOrigins, origin) != options.allowedOrigins.end();
}

}  // namespace caustream::net
