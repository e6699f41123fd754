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

// What these two return is the callback's return value.
int respond(lws* socket, HttpExchange* exchange, HttpResponse response);
int writeBody(lws* socket, HttpExchange* exchange);

void endExchange(HttpExchange* exchange);

}  // namespace caustream::net
