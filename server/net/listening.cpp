#include "net/listening.h"

#include <arpa/inet.h>
#include <openssl/ssl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "error.h"

namespace caustream::net {

void probePort(const ServerOptions& options) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(options.port));
    if (inet_pton(AF_INET, options.bind.c_str(), &address.sin_addr) != 1) {
        throw Error("bind address; '" + options.bind + "' is not an IPv4 address; try 127.0.0.1 or 0.0.0.0");
    }
    const int probe = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int yes = 1;
    setsockopt(probe, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    const int result = bind(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address);
    const int problem = errno;
    const bool listens = result == 0 && listen(probe, 1) == 0;
    const int listenProblem = errno;
    close(probe);
    if (!listens) {
        throw Error(std::string(std::strerror(result == 0 ? listenProblem : problem)) + "; " + options.bind + ":" +
                    std::to_string(options.port) + "; stop the program that holds the port, or pass --port 0 for a free one");
    }
}

void addTls(lws_context_creation_info& info, const ServerOptions& options) {
    info.options |= LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT;
    // Plain http on this port gets an answer that says so, and nothing else: refuse() of net/admission.h.
    info.options |= LWS_SERVER_OPTION_ALLOW_NON_SSL_ON_SSL_PORT | LWS_SERVER_OPTION_ALLOW_HTTP_ON_HTTPS_LISTENER;
    info.ssl_cert_filepath = options.tlsCert.c_str();
    info.ssl_private_key_filepath = options.tlsKey.c_str();
    info.ssl_options_set = SSL_OP_NO_SSLv3 | SSL_OP_NO_TLSv1 | SSL_OP_NO_TLSv1_1 | SSL_OP_NO_COMPRESSION | SSL_OP_NO_RENEGOTIATION;
}

}  // namespace caustream::net
