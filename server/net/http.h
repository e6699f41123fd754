// What the port answers to a plain HTTP GET: the page's files. Values only; no sockets.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "embedded/file.h"

namespace caustream::net {

struct HttpRequest {
    std::string path;         // without the query
    std::string ifNoneMatch;  // the header, empty when absent
};

struct HttpResponse {
    int status = 200;
    std::string contentType = "text/plain; charset=utf-8";
    std::string body;
    std::string etag;  // empty: Cache-Control is no-store
};

// "/" is index.html, the others go by name; 304 when the caller has the same bytes, 404 for what there is not.
HttpResponse pageFile(std::span<const embedded::File> files, const HttpRequest& request);

// Sent with every answer: the page may talk to its own origin and to nothing else.
std::string_view contentSecurityPolicy();

// True if `origin` (a header; empty is a program, not a page) is a page that `host` served.
bool sameHost(std::string_view origin, std::string_view host);

// True for localhost, *.localhost and IP addresses, with or without a port.
bool isLocalName(std::string_view host);

}  // namespace caustream::net
