// Every socket of the port from accept to close: how many there are and from where, and by when each that speaks plain HTTP
// has to get on, so that nobody holds one by sending a request letter by letter. Network thread only.
#pragma once
#include <sys/socket.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

struct lws;

namespace caustream::net {

class SocketTable {
   public:
    static constexpr std::uint64_t kHeadUs = 5'000'000;     // for TLS and a request's head, the next one's too
    static constexpr std::uint64_t kAnswerUs = 30'000'000;  // for taking an answer, a page's file at most

    SocketTable(std::size_t most, std::size_t mostPerAddress) : most_(most), mostPerAddress_(mostPerAddress) {}

    // False when there are too many, in all or from where this one comes; counted then.
    bool admits(const sockaddr_storage& from);

    void opened(lws* socket, std::uint64_t nowUs);
    void asked(lws* socket, std::uint64_t nowUs);      // the head of a request is complete
    void answered(lws* socket, std::uint64_t nowUs);   // and the answer; another request may follow
    void upgraded(lws* socket);                        // a WebSocket: its viewer looks after it
    void closed(lws* socket);

    // Those whose time is over.
    std::vector<lws*> overdue(std::uint64_t nowUs) const;

    std::size_t size() const { return sockets_.size(); }
    std::uint64_t refused() const { return refused_; }

   private:
    struct Entry {
        std::uint32_t address;  // IPv4, network order
        std::uint64_t dueUs;    // 0: a WebSocket
    };
    void due(lws* socket, std::uint64_t dueUs);

    std::size_t most_, mostPerAddress_;
    std::map<lws*, Entry> sockets_;
    std::map<std::uint32_t, std::size_t> perAddress_;
    std::uint64_t refused_ = 0;
};

}  // namespace caustream::net
