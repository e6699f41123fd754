#include "net/http.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <utility>

namespace caustream::net {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kTypes = {{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".jpg", "image/jpeg"},
    {".ico", "image/x-icon"},
    {".json", "application/json"},
}};

std::string_view contentType(std::string_view name) {
    for (const auto& [ending, type] : kTypes) {
        if (name.ends_with(ending)) {
            return type;
        }
    }
    return "application/octet-stream";
}

std::string etagOf(std::string_view bytes) {  // FNV-1a, 64 bits: tells versions apart, proves nothing
    std::uint64_t hash = 14695981039346656037u;
    for (const char byte : bytes) {
        hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211u;
    }
    std::array<char, 24> text{};
    std::snprintf(text.data(), text.size(), "\"%016llx\"", static_cast<unsigned long long>(hash));
    return text.data();
}

std::string_view hostName(std::string_view host) {
    if (host.starts_with('[')) {
        return host.substr(1, host.find(']') - 1);
    }
    return host.substr(0, host.find(':'));
}

}  // namespace

HttpResponse pageFile(std::span<const embedded::File> files, const HttpRequest& request) {
    const std::string_view path = request.path;
    const std::string_view name = path == "/" ? "index.html" : path.substr(path.starts_with('/') ? 1 : 0);
    const auto file = std::ranges::find(files, name, &embedded::File::name);
    if (file == files.end()) {
        return {.status = 404, .body = "There is no page of this name here; the viewer is at /.\n"};
    }
    HttpResponse response{.contentType = std::string(contentType(name)), .etag = etagOf(file->bytes)};
    if (request.ifNoneMatch == response.etag) {
        response.status = 304;
    } else {
        response.body = file->bytes;
    }
    return response;
}

std::string_view contentSecurityPolicy() {
    // 'self' covers ws: of the same host and port in the browsers of today; blob: is how a decoded picture may be shown.
    return "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self'; "
           "worker-src 'self' blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
}

bool sameHost(std::string_view origin, std::string_view host) {
    if (origin.empty()) {
        return true;
    }
    const std::size_t scheme = origin.find("://");
    return scheme != std::string_view::npos && !host.empty() && origin.substr(scheme + 3) == host;
}

bool isLocalName(std::string_view host) {
    const std::string_view name = hostName(host);
    if (host.starts_with('[')) {
        return !name.empty() && name.find_first_not_of("0123456789abcdefABCDEF:.") == std::string_view::npos;
    }
    const bool digits = !name.empty() && name.find_first_not_of("0123456789.") == std::string_view::npos;
    return digits || name == "localhost" || name.ends_with(".localhost");
}

}  // namespace caustream::net
