#include "net/socket_table.h"

#include <libwebsockets.h>
#include <netinet/in.h>

namespace caustream::net {
namespace {

std::uint32_t ipv4(const sockaddr_storage& address) {
    return address.ss_family == AF_INET ? reinterpret_cast<const sockaddr_in&>(address).sin_addr.s_addr : 0;
}

}  // namespace

bool SocketTable::admits(const sockaddr_storage& from) {
    const auto same = perAddress_.find(ipv4(from));
    if (sockets_.size() < most_ && (same == perAddress_.end() || same->second < mostPerAddress_)) {
        return true;
    }
    ++refused_;
    return false;
}

void SocketTable::opened(lws* socket, std::uint64_t nowUs) {
    sockaddr_storage from{};
    socklen_t size = sizeof from;
    getpeername(lws_get_socket_fd(socket), reinterpret_cast<sockaddr*>(&from), &size);
    const std::uint32_t address = ipv4(from);
    if (sockets_.emplace(socket, Entry{address, nowUs + kHeadUs}).second) {
        ++perAddress_[address];
    }
}

void SocketTable::due(lws* socket, std::uint64_t dueUs) {
    if (const auto entry = sockets_.find(socket); entry != sockets_.end()) {
        entry->second.dueUs = dueUs;
    }
}

void SocketTable::asked(lws* socket, std::uint64_t nowUs) { due(socket, nowUs + kAnswerUs); }
void SocketTable::answered(lws* socket, std::uint64_t nowUs) { due(socket, nowUs + kHeadUs); }
void SocketTable::upgraded(lws* socket) { due(socket, 0); }

void SocketTable::closed(lws* socket) {
    const auto entry = sockets_.find(socket);
    if (entry == sockets_.end()) {
        return;
    }
    if (const auto same = perAddress_.find(entry->second.address); --same->second == 0) {
        perAddress_.erase(same);
    }
    sockets_.erase(entry);
}

std::vector<lws*> SocketTable::overdue(std::uint64_t nowUs) const {
    std::vector<lws*> late;
    for (const auto& [socket, entry] : sockets_) {
        if (entry.dueUs != 0 && nowUs > entry.dueUs) {
            late.push_back(socket);
        }
    }
    return late;
}

}  // namespace caustream::net
