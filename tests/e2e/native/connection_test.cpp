// The connection library against servers that come and go.
#include <gtest/gtest.h>

#include <csignal>
#include <functional>

#include "client/connection/connection.h"
#include "program.h"

namespace caustream::e2e {
namespace {

using namespace std::chrono_literals;
using connection::Connection;
using protocol::Json;

connection::Options optionsFor(const std::string& url) {
    return {.address = *connection::parseAddress(url), .clientName = "connection_test"};
}

// The next frame that `fits`; acknowledges all. Nothing after a minute: a server that is slow, but not one that is
// still.
std::optional<connection::Frame> frameThat(Connection& connection,
                                           const std::function<bool(const connection::Frame&)>& fits) {
    for (const auto last = std::chrono::steady_clock::now() + 60s; std::chrono::steady_clock::now() < last;
         connection.wait(100ms)) {
        auto frame = connection.takeFrame();
        if (!frame) continue;
        connection.acknowledge(*frame, 0);
        if (fits(*frame)) return frame;
    }
    return std::nullopt;
}

bool anything(const connection::Frame&) {
    return true;
}

TEST(Address, LosesTheServerThatWasNamedAndNothingElse) {
    const auto without = [](const char* url) { return connection::anyServer(*connection::parseAddress(url)).text(); };
    EXPECT_EQ(without("http://a:1/ws?srv=b"), "ws://a:1/ws");
    EXPECT_EQ(without("http://a:1/ws?x=1&srv=b&y=2"), "ws://a:1/ws?x=1&y=2");
    EXPECT_EQ(without("https://a:1"), "wss://a:1/ws");
}

TEST(Address, TakesWhatPeopleWrite) {
    const auto text = [](const char* url) {
        const auto address = connection::parseAddress(url);
        return address ? address->text() : "error";
    };
    EXPECT_EQ(text("http://127.0.0.1:9720/"), "ws://127.0.0.1:9720/ws");
    EXPECT_EQ(text("ws://host:1/ws?srv=a"), "ws://host:1/ws?srv=a");
    EXPECT_EQ(text("http://host:1/?srv=a"), "ws://host:1/ws?srv=a");
    EXPECT_EQ(text("host:65535"), "ws://host:65535/ws");
    EXPECT_EQ(text("host"), "ws://host:80/ws");
    EXPECT_EQ(text("http://[::1]:5/"), "ws://[::1]:5/ws");
    EXPECT_EQ(text("https://host/"), "wss://host:443/ws");
    EXPECT_EQ(text("wss://host:9443/?srv=a"), "wss://host:9443/ws?srv=a");
    for (const char* wrong : {"", "http://", "https://", "http://host:0", "http://host:65536", "http://host:x",
                              "ftp://host", "http://[::1"})
        EXPECT_EQ(text(wrong), "error") << wrong;
}

TEST(Connection, ComesBackAndSaysItAllAgain) {
    auto server = std::make_unique<Server>();
    Connection connection(optionsFor(server->url()));
    ASSERT_TRUE(connection.update({{"scene", {"builtin", "sphere"}}, {"stream", {{"width", 64}, {"height", 48}}}}));
    connection.startStream(false);
    ASSERT_TRUE(frameThat(connection, [](const auto& frame) { return frame.image.width == 64; }));

    // Killed, not stopped: nobody says goodbye. Another server takes the port and knows nothing.
    const std::string port = server->port();
    server->kill();
    ASSERT_TRUE(connection.update({{"stream", {{"height", 32}}}})) << "changes are kept while there is no server";
    server = std::make_unique<Server>(std::vector<std::string>{"--port", port});
    const auto frame = frameThat(connection, anything);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->image.width, 64);
    EXPECT_EQ(frame->image.height, 32);
    EXPECT_EQ(connection.document()["scene"], (Json{"builtin", "sphere"}));
}

TEST(Connection, KeepsOnlyWhatTheServerTook) {
    Server server;
    Connection connection(optionsFor(server.url()));
    ASSERT_TRUE(connection.update({{"stream", {{"width", 64}, {"height", 64}}}}));
    connection.startStream(false);
    ASSERT_TRUE(frameThat(connection, anything));
    EXPECT_FALSE(connection.update({{"stream", {{"width", 1}}}})) << "the protocol refuses it here already";
    ASSERT_TRUE(connection.update({{"scene", {"builtin", "nowhere"}}}));
    bool refused = false;
    for (int i = 0; i < 600 && !refused; ++i, connection.wait(100ms))
        for (const auto& event : connection.takeEvents())
            refused |= std::holds_alternative<protocol::ErrorMessage>(event);
    ASSERT_TRUE(refused);
    EXPECT_FALSE(connection.document().contains("scene"));
    EXPECT_EQ(connection.document()["stream"]["width"], 64);
}

TEST(Connection, AnInputComesBackInTheHeader) {
    Server server;
    Connection connection(optionsFor(server.url()));
    ASSERT_TRUE(connection.update({{"stream", {{"width", 64}, {"height", 64}}}}));
    connection.startStream(false);
    ASSERT_TRUE(frameThat(connection, anything));
    const std::uint64_t before = connection::nowUs();
    const auto seq = connection.input({{"camera", {{"fov_y_deg", 30.0}}}});
    ASSERT_TRUE(seq);
    const auto frame = frameThat(connection, [&](const auto& f) { return f.header.inputSeq == *seq; });
    ASSERT_TRUE(frame);
    EXPECT_GE(frame->header.clientUs, before);
    EXPECT_LE(frame->header.clientUs, connection::nowUs());
}

}  // namespace
}  // namespace caustream::e2e
