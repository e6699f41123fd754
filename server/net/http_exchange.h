// One HTTP answer on its way through libwebsockets: head at once, body when the socket takes it. Network thread only.
#pragma once
#include <libwebsockets.h>

#include <string>

#include "net/http.h"

namespace caustream::net {

struct HttpExchange {   // lies in libwebsockets' memory, zeroed
    std::string* body;  // owned until endExchange()
};

// A request header's value, empty when absent. Always a copy: libwebsockets keeps long ones in pieces.
std::string requestHeader(lws* socket, lws_token_indexes token);

struct Step {
    int result;     // the callback's return value
    bool answered;  // the answer is out, and libwebsockets has taken the exchange's memory back: another request may follow
};
Step respond(lws* socket, HttpExchange* exchange, HttpResponse response);
Step writeBody(lws* socket, HttpExchange* exchange);

void endExchange(HttpExchange* exchange);

}  // namespace caustream::net
