#include "net/http_exchange.h"

#include <utility>

namespace caustream::net {
namespace {

bool addHeader(lws* socket, std::string_view name, std::string_view value, unsigned char** at, unsigned char* end) {
    return lws_add_http_header_by_name(socket, reinterpret_cast<const unsigned char*>(std::string(name).c_str()),
                                       reinterpret_cast<const unsigned char*>(value.data()),
                                       static_cast<int>(value.size()), at, end) == 0;
}

}  // namespace

std::string requestHeader(lws* socket, lws_token_indexes token) {
    const int length = lws_hdr_total_length(socket, token);
    if (length <= 0) {
        return {};
    }
    std::string value(static_cast<std::size_t>(length) + 1, '\0');
    const int copied = lws_hdr_copy(socket, value.data(), length + 1, token);
    value.resize(copied > 0 ? static_cast<std::size_t>(copied) : 0);
    return value;
}

void endExchange(HttpExchange* exchange) {
    if (exchange) {
        delete std::exchange(exchange->body, nullptr);
    }
}

Step respond(lws* socket, HttpExchange* exchange, HttpResponse response) {
    unsigned char buffer[LWS_PRE + 4096];
    unsigned char *start = buffer + LWS_PRE, *at = start, *end = buffer + sizeof buffer;
    const bool good =
        lws_add_http_common_headers(socket, static_cast<unsigned>(response.status), response.contentType.c_str(),
                                    response.body.size(), &at, end) == 0 &&
        addHeader(socket, "cache-control:", response.etag.empty() ? "no-store" : "no-cache", &at, end) &&
        (response.etag.empty() || addHeader(socket, "etag:", response.etag, &at, end)) &&
        addHeader(socket, "content-security-policy:", contentSecurityPolicy(), &at, end) &&
        addHeader(socket, "x-content-type-options:", "nosniff", &at, end) &&
        addHeader(socket, "referrer-policy:", "no-referrer", &at, end) &&
        lws_finalize_write_http_header(socket, start, &at, end) == 0;
    if (!good) {
        return {-1, false};
    }
    if (response.body.empty()) {
        return {lws_http_transaction_completed(socket) ? -1 : 0, true};
    }
    endExchange(exchange);
    exchange->body = new std::string(std::string(LWS_PRE, '\0') + response.body);
    lws_callback_on_writable(socket);
    return {0, false};
}

Step writeBody(lws* socket, HttpExchange* exchange) {
    if (!exchange->body) {
        return {0, false};
    }
    const int size = static_cast<int>(exchange->body->size() - LWS_PRE);
    const int sent = lws_write(socket, reinterpret_cast<unsigned char*>(exchange->body->data()) + LWS_PRE,
                               static_cast<std::size_t>(size), LWS_WRITE_HTTP_FINAL);
    endExchange(exchange);
    return {sent < size || lws_http_transaction_completed(socket) ? -1 : 0, true};
}

}  // namespace caustream::net
