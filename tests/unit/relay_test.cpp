// The relay between two sockets: every byte, in order, both ways, whatever the links' shape; and the end of either side.
#include "bench/stream/relay.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <string>
#include <thread>

namespace caustream::bench {
namespace {

int listener(int& port) {
    const int descriptor = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(bind(descriptor, reinterpret_cast<const sockaddr*>(&address), size), 0);
    EXPECT_EQ(listen(descriptor, 4), 0);
    getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size);
    port = ntohs(address.sin_port);
    return descriptor;
}

int connectTo(int port) {
    const int descriptor = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    return descriptor;
}

void sendAll(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t size = send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        ASSERT_GT(size, 0);
        bytes.remove_prefix(static_cast<std::size_t>(size));
    }
}

std::string receive(int descriptor, std::size_t most) {
    std::string bytes;
    std::array<char, 65536> buffer;
    for (ssize_t size = 1; bytes.size() < most && size > 0;) {
        size = recv(descriptor, buffer.data(), std::min(buffer.size(), most - bytes.size()), 0);
        if (size > 0) bytes.append(buffer.data(), static_cast<std::size_t>(size));
    }
    return bytes;
}

std::string pattern(std::size_t size) {
    std::string bytes(size, '\0');
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * 31 + i / 251);
    return bytes;
}

TEST(Relay, PassesEveryByteBothWaysAndTheEnd) {
    int port = 0;
    const int listening = listener(port);
    const std::string down = pattern(1'000'000), up = pattern(70'000);
    for (const NetworkShape& shape : {NetworkShape{}, NetworkShape{{5e6, 0}, {}}, NetworkShape{{2e7, 20'000}, {1e6, 20'000}}}) {
        Relay relay(port, shape);
        const int client = connectTo(relay.port());
        const int server = accept(listening, nullptr, nullptr);
        std::string atServer;
        std::thread serving([&] {
            atServer = receive(server, up.size());
            sendAll(server, down);
            close(server);
        });
        std::thread asking([&] { sendAll(client, up); });
        const std::string atClient = receive(client, down.size() + 1);   // to the end
        asking.join();
        serving.join();
        close(client);
        EXPECT_EQ(atServer, up);
        EXPECT_EQ(atClient, down);
        EXPECT_EQ(relay.bytesToClients(), down.size());
    }
    close(listening);
}

// While it runs, from a rate at which a megabyte would take for ever.
TEST(Relay, AnotherShapeHoldsForConnectionsThatAreThere) {
    int port = 0;
    const int listening = listener(port);
    Relay relay(port, {{1000, 0}, {}});
    const int client = connectTo(relay.port());
    const int server = accept(listening, nullptr, nullptr);
    const std::string bytes = pattern(1'000'000);
    std::thread serving([&] { sendAll(server, bytes); });
    relay.reshape({});
    EXPECT_EQ(receive(client, bytes.size()), bytes);
    serving.join();
    close(server);
    close(client);
    close(listening);
}

}  // namespace
}  // namespace caustream::bench
