// A slow network on loopback: listens on a port of its own and passes each connection on to a server through two links.
// The kernel's buffers on either side are kept small, so that what waits, waits where it would on a slow network: in the
// sender. One thread, which ends with the object.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "bench/stream/link.h"

namespace caustream::bench {

struct NetworkShape {
    LinkShape toClient, toServer;
};

class Relay {
   public:
    // Of every connection by itself. Throws Error when there is no port to listen on.
    Relay(int serverPort, NetworkShape shape);
    ~Relay();  // closes all connections
    Relay(const Relay&) = delete;

    int port() const { return port_; }
    void reshape(NetworkShape shape);                     // any thread; the connections there are and those to come
    std::uint64_t bytesToClients() const { return bytesToClients_; }

   private:
    struct Connection;
    void run();
    void accept();
    void wake();

    int serverPort_, port_ = 0;
    int listener_ = -1, event_ = -1;
    std::mutex mutex_;
    NetworkShape shape_;        // guarded by mutex_
    bool reshaped_ = false;     // guarded by mutex_
    bool stopping_ = false;     // guarded by mutex_
    std::atomic<std::uint64_t> bytesToClients_{0};
    std::vector<std::unique_ptr<Connection>> connections_;   // the relay's thread
    std::thread thread_;
};

}  // namespace caustream::bench
