// What libwebsockets needs to know to listen, checked before it is asked.
#pragma once
#include <libwebsockets.h>

#include "net/server_options.h"

namespace caustream::net {

// Throws Error with the system's own words where libwebsockets would only say that it could not: the port is taken, the
// address is not this machine's.
void probePort(const ServerOptions& options);

// TLS 1.2 and later with the options' certificate. `info` points into `options` from then on.
void addTls(lws_context_creation_info& info, const ServerOptions& options);

}  // namespace caustream::net
