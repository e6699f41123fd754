// Whose requests are answered, going by their heads.
#pragma once
#include <libwebsockets.h>

#include "net/server_options.h"

namespace caustream::net {

// A callback's return value: 0, or -1 once the reason has been sent. `upgrade`: the request asks for another protocol.
int refuse(lws* socket, const ServerOptions& options, bool upgrade);

// Our own page, one of the options', or no page at all.
bool allowsOrigin(lws* socket, const ServerOptions& options);

}  // namespace caustream::net
