// Who dribbles, floods, never reads or comes in crowds loses the socket, and only that: the next viewer is served.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <memory>

#include "../raw_client.h"
#include "lone_port.h"

namespace caustream::e2e {
namespace {

using testing::HasSubstr;

const std::string kUpgrade =
    "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";

class TcpSocket {
   public:
    explicit TcpSocket(int port) : descriptor_(connectTo(port)) {}
    ~TcpSocket() { close(descriptor_); }
    TcpSocket(const TcpSocket&) = delete;
    TcpSocket& operator=(const TcpSocket&) = delete;

    void send(std::string_view bytes) { ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL); }

    // Ended by the far side, which said nothing before.
    bool ended() {
        char byte = 0;
        const ssize_t size = recv(descriptor_, &byte, 1, MSG_DONTWAIT);
        return size == 0 || (size < 0 && errno == ECONNRESET);
    }

   private:
    int descriptor_;
};

bool serves(LonePort& port) { return httpGet(port.port(), "/hello").find("/hello") != std::string::npos; }

TEST(HostileSockets, ARequestThatNeverComesToItsEnd) {
    LonePort port;
    TcpSocket silent(port.port()), dribbling(port.port());
    dribbling.send("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n");
    EXPECT_TRUE(LonePort::eventually([&] {
        dribbling.send("X");
        return silent.ended() && dribbling.ended();
    }));
    EXPECT_EQ(port.counts().slow, 2u);
    EXPECT_TRUE(serves(port));
}

TEST(HostileSockets, ASecondRequestThatNeverComesToItsEnd) {
    LonePort port;
    TcpSocket socket(port.port());
    socket.send("GET /one HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\nGET /tw");
    ASSERT_TRUE(LonePort::eventually([&] { return port.counts().open == 1; }));
    EXPECT_TRUE(LonePort::eventually([&] {
        socket.send("o");
        return port.counts().open == 0;
    })) << port.counts().open << " open, " << port.counts().slow << " slow";
    EXPECT_TRUE(serves(port));
}

TEST(HostileSockets, ViewersThatStayAreNotCounted) {
    LonePort port;
    RawClient viewer(port.port());
    TcpSocket silent(port.port());
    EXPECT_TRUE(LonePort::eventually([&] { return silent.ended(); }));  // longer than any request may take
    viewer.text("still here");
    EXPECT_TRUE(LonePort::eventually([&] { return port.messages == 1; }));
    EXPECT_EQ(port.closings, 0);
}

TEST(HostileSockets, CrowdsAreTurnedAway) {
    LonePort port({.maxConnections = 100, .maxPerAddress = 3});
    std::vector<std::unique_ptr<TcpSocket>> crowd;
    for (int i = 0; i < 3; ++i) {
        crowd.push_back(std::make_unique<TcpSocket>(port.port()));
    }
    ASSERT_TRUE(LonePort::eventually([&] { return port.counts().open == 3; }));
    TcpSocket fourth(port.port());
    EXPECT_TRUE(LonePort::eventually([&] { return fourth.ended(); }));
    EXPECT_EQ(port.counts().refused, 1u);
    crowd.clear();
    ASSERT_TRUE(LonePort::eventually([&] { return port.counts().open == 0; }));
    EXPECT_TRUE(serves(port));
}

TEST(HostileSockets, MoreThanThePortHolds) {
    LonePort port({.maxConnections = 5, .maxPerAddress = 100});
    std::vector<std::unique_ptr<TcpSocket>> crowd;
    for (int i = 0; i < 5; ++i) {
        crowd.push_back(std::make_unique<TcpSocket>(port.port()));
    }
    ASSERT_TRUE(LonePort::eventually([&] { return port.counts().open == 5; }));
    TcpSocket sixth(port.port());
    EXPECT_TRUE(LonePort::eventually([&] { return sixth.ended(); }));
    crowd.pop_back();
    ASSERT_TRUE(LonePort::eventually([&] { return port.counts().open == 4; }));
    EXPECT_TRUE(serves(port));
}

// Sends a hundred thousand empty texts at a time, until the connection is closed.
void flood(LonePort& port) {
    port.mostMessages = 10;
    RawClient viewer(port.port());
    fcntl(viewer.descriptor(), F_SETFL, O_NONBLOCK);
    std::string burst;
    for (int i = 0; i < 1000; ++i) {
        burst.append("\x81\x80\0\0\0\0", 6);
    }
    EXPECT_TRUE(LonePort::eventually([&] {
        for (int i = 0; i < 100; ++i) {
            send(viewer.descriptor(), burst.data(), burst.size(), MSG_NOSIGNAL);
        }
        return port.closings == 1;
    }));
    EXPECT_EQ(port.messages, 11) << "what came after the end was read";
}

TEST(HostileSockets, AFloodIsNotReadAfterItsEnd) {
    LonePort port;
    flood(port);
    EXPECT_TRUE(serves(port));
}

// Here the close frame does not get out: what waits before it is not read.
TEST(HostileSockets, AFloodOfWhoDoesNotRead) {
    LonePort port;
    port.messageBytes = 8u << 20;
    flood(port);
    EXPECT_EQ(port.counts().flooding, 1u);
    EXPECT_EQ(port.counts().stuck, 0u);
    EXPECT_TRUE(serves(port));
}

TEST(HostileSockets, AMessageInLetters) {
    LonePort port;
    RawClient viewer(port.port());
    viewer.send(0x2, "", false);
    for (int i = 0; i < 200; ++i) {
        viewer.send(0x0, i % 2 ? "x" : "", false);
    }
    EXPECT_EQ(viewer.next(20'000).closeCode, 4429);
    RawClient sensible(port.port());
    sensible.send(0x2, std::string(300, 'a'), false);
    for (int i = 0; i < 200; ++i) {
        sensible.send(0x0, std::string(300, 'a'), i == 199);
    }
    EXPECT_TRUE(LonePort::eventually([&] { return port.messages == 1; }));
}

constexpr std::string_view kPong("\x8a\x80\0\0\0\0", 6);  // nobody asked, but it looks alive

TEST(HostileSockets, WhoTakesNothingIsLetGo) {
    LonePort port({.pingS = 60, .deadS = 2});
    port.messageBytes = 1u << 20;
    RawClient viewer(port.port());
    EXPECT_TRUE(LonePort::eventually([&] {
        viewer.bytes(kPong);
        return port.closings == 1;
    }));
    EXPECT_EQ(port.counts().stuck, 1u);
    EXPECT_TRUE(serves(port));
}

TEST(HostileSockets, WhoTakesLittleStays) {
    LonePort port({.pingS = 60, .deadS = 2});
    port.messageBytes = 8u << 20;  // longer on its way than the two seconds
    RawClient viewer(port.port());
    const int small = 64 << 10;
    setsockopt(viewer.descriptor(), SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
    std::vector<char> buffer(32 << 10);
    for (int i = 0; i < 60; ++i) {  // 2 MB in 6 s
        recv(viewer.descriptor(), buffer.data(), buffer.size(), 0);
        viewer.bytes(kPong);
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    EXPECT_EQ(port.closings, 0);
    EXPECT_EQ(port.counts().stuck, 0u);
}

TEST(HostileSockets, OnlyOurUpgradeIsTaken) {
    LonePort port({.allowedOrigins = {"https://friend.example"}});
    const std::string ours = kUpgrade + "Sec-WebSocket-Protocol: caustream.v1\r\n";
    const auto answer = [&](const std::string& headers, std::string_view path = "/ws") { return httpGet(port.port(), path, headers); };
    EXPECT_THAT(answer(kUpgrade), HasSubstr(" 400 ")) << "no subprotocol";
    const std::string other = answer(kUpgrade + "Sec-WebSocket-Protocol: caustream.v9\r\n");
    EXPECT_THAT(other, HasSubstr(" 400 "));
    EXPECT_THAT(other, HasSubstr("caustream.v1"));
    EXPECT_THAT(answer(kUpgrade + "Sec-WebSocket-Protocol: http\r\n"), HasSubstr(" 400 "));
    EXPECT_THAT(answer("Connection: Upgrade, HTTP2-Settings\r\nUpgrade: h2c\r\nHTTP2-Settings: AAMAAABkAAQAAP__\r\n", "/"),
                HasSubstr(" 400 "));
    EXPECT_THAT(answer("Connection: Upgrade\r\nUpgrade: tls/1.2\r\n", "/"), HasSubstr(" 403 "));
    EXPECT_THAT(answer(ours + "Origin: https://evil.example\r\n"), HasSubstr(" 403 "));
    EXPECT_THAT(answer(ours + "Origin: https://friend.example.evil.example\r\n"), HasSubstr(" 403 "));
    EXPECT_THAT(answer(ours + "Origin: null\r\n"), HasSubstr(" 403 "));
    EXPECT_THAT(answer(ours, "/elsewhere"), HasSubstr(" 404 "));
    EXPECT_EQ(port.openings, 0);
    RawClient friendly(port.port(), "/ws?srv=a", "Origin: https://friend.example\r\n");
    RawClient own(port.port(), "/ws", "Origin: http://127.0.0.1:" + std::to_string(port.port()) + "\r\n");
    EXPECT_TRUE(LonePort::eventually([&] { return port.openings == 2; }));
}

}  // namespace
}  // namespace caustream::e2e
