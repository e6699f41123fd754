// Connections that lose their server, and one that follows another.
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>

#include "../raw_client.h"
#include "client/connection/connection.h"
#include "program.h"

namespace caustream::e2e {
namespace {

using namespace std::chrono_literals;
using connection::Connection;
using protocol::Json;

connection::Options optionsFor(const std::string& url, const std::string& follow = "") {
    connection::Options options{.address = *connection::parseAddress(url), .clientName = "return_test"};
    options.follow = follow;
    return options;
}

// A viewer that looks: its newest words, and the size of its newest picture.
struct Viewer {
    explicit Viewer(connection::Options options) : connection(std::move(options)) {
        EXPECT_TRUE(connection.update({{"stream", {{"width", 64}, {"height", 48}}}}));
        connection.startStream(false);
    }

    // Looks until `fits`; false after a minute.
    bool until(const std::function<bool()>& fits) {
        for (const auto last = std::chrono::steady_clock::now() + 60s; std::chrono::steady_clock::now() < last;
             connection.wait(50ms)) {
            for (const auto& event : connection.takeEvents()) {
                if (const auto* message = std::get_if<protocol::Welcome>(&event)) welcome = *message;
                if (const auto* message = std::get_if<protocol::StateMessage>(&event)) state = message->state;
                if (const auto* message = std::get_if<protocol::ErrorMessage>(&event)) error = message->message;
                if (const auto* ok = std::get_if<protocol::Ok>(&event)) recording = ok->recording.value_or(recording);
                if (const auto* status = std::get_if<protocol::Status>(&event)) statuses[status->key] = status->message;
                if (const auto* end = std::get_if<connection::Disconnected>(&event)) ended = *end;
            }
            if (const auto frame = connection.takeFrame()) {
                connection.acknowledge(*frame, 0);
                ++frames;
            }
            if (fits()) return true;
        }
        return false;
    }
    bool sees(int more) {
        return until([this, enough = frames + more] { return frames >= enough; });
    }
    Json scene() const { return state.is_object() ? state["scene"] : Json{}; }
    Json light() const { return state.is_object() ? state["lights"]["key"]["position"] : Json{}; }

    std::optional<protocol::Welcome> welcome;
    Json state;
    std::string error, recording;
    std::map<std::string, std::string> statuses;
    std::optional<connection::Disconnected> ended;
    int frames = 0;
    Connection connection;
};

std::unique_ptr<Server> another(std::unique_ptr<Server> server, const std::function<void()>& meanwhile = {}) {
    const std::string port = server->port();
    server->kill();
    if (meanwhile) meanwhile();
    return std::make_unique<Server>(std::vector<std::string>{"--port", port});
}

// Takes a session away from whoever has it. What the server says of it.
Json takeOver(const Server& server, const std::string& session) {
    RawClient taker(std::stoi(server.port()));
    taker.json({{"op", "hello"}, {"id", 1}, {"client", {{"name", "taker"}, {"version", "1"}}}, {"resume", {{"session", session}}}});
    return taker.textOf("welcome").value_or(Json{});
}

TEST(Return, TheSessionKeepsItsNameAndWhatWasChangedMeanwhile) {
    auto server = std::make_unique<Server>();
    Viewer viewer(optionsFor(server->url()));
    ASSERT_TRUE(viewer.connection.update({{"scene", {"builtin", "sphere"}}}));
    ASSERT_TRUE(viewer.connection.input({{"camera", {{"fov_y_deg", 33.0}}}}));
    ASSERT_TRUE(viewer.sees(1));
    const std::string session = viewer.welcome->session;
    server = another(std::move(server), [&] {
        ASSERT_TRUE(viewer.until([&] { return viewer.ended.has_value(); }));
        EXPECT_TRUE(viewer.ended->willRetry);
        ASSERT_TRUE(viewer.connection.input({{"lights", {{"key", {{"position", {0.125, 1.5, 0.25}}}}}}}));
    });
    viewer.welcome.reset();
    ASSERT_TRUE(viewer.until([&] { return viewer.welcome.has_value(); }));
    EXPECT_EQ(viewer.welcome->session, session);
    EXPECT_FALSE(viewer.welcome->resumed) << "this server never knew it";
    EXPECT_TRUE(viewer.sees(1));
    EXPECT_EQ(viewer.error, "");
    const Json welcome = takeOver(*server, session);
    EXPECT_EQ(welcome["resumed"], true);
    EXPECT_EQ(welcome["state"]["scene"], (Json{"builtin", "sphere"}));
    EXPECT_EQ(welcome["state"]["camera"]["fov_y_deg"], 33.0);
    EXPECT_EQ(welcome["state"]["lights"]["key"], (Json{{"position", {0.125, 1.5, 0.25}}}));
}

TEST(Return, AFileThatTheServerLacksIsSentAgain) {
    auto server = std::make_unique<Server>();
    Viewer viewer(optionsFor(server->url()));
    std::ifstream in(CAUSTREAM_SPHERE_GLB, std::ios::binary);
    const std::vector<std::uint8_t> glb{std::istreambuf_iterator<char>(in), {}};
    viewer.connection.showFile(glb);
    const Json scene{"asset", connection::sha256Hex(glb)};
    ASSERT_TRUE(viewer.until([&] { return viewer.scene() == scene; }));
    ASSERT_TRUE(viewer.connection.input({{"camera", {{"fov_y_deg", 33.0}}}}));
    ASSERT_TRUE(viewer.sees(1));

    server = another(std::move(server));
    viewer.welcome.reset();
    viewer.state = Json{};
    ASSERT_TRUE(viewer.until([&] { return viewer.welcome.has_value(); }));
    EXPECT_EQ(viewer.welcome->missingAssets, std::vector<std::string>{scene[1]});
    ASSERT_TRUE(viewer.until([&] { return viewer.scene() == scene; }));
    EXPECT_EQ(viewer.state["camera"]["fov_y_deg"], 33.0);
    EXPECT_TRUE(viewer.sees(1));
    EXPECT_EQ(viewer.error, "");
}

TEST(Return, OneWhoseSessionWasTakenDoesNotTakeItBack) {
    Server server;
    Viewer viewer(optionsFor(server.url()));
    ASSERT_TRUE(viewer.sees(1));
    EXPECT_EQ(takeOver(server, viewer.welcome->session)["resumed"], true);
    ASSERT_TRUE(viewer.until([&] { return viewer.ended.has_value(); }));
    EXPECT_EQ(viewer.ended->closeCode, 4409);
    EXPECT_FALSE(viewer.ended->willRetry);
    // Not by itself; but when a person says so.
    viewer.welcome.reset();
    viewer.connection.reconnect();
    EXPECT_TRUE(viewer.until([&] { return viewer.welcome.has_value(); }));
    EXPECT_TRUE(viewer.sees(1));
}

TEST(Tls, ACertificateIsCheckedAndWhatIsWrongWithItSaid) {
    const TemporaryFolder folder;
    const auto made = [&](const std::string& name, const std::string& madeOutFor) {
        const Result openssl = run("openssl", {"req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=test", "-addext",
                                               "subjectAltName=" + madeOutFor, "-keyout", folder / (name + ".key"), "-out", folder / (name + ".pem")});
        EXPECT_EQ(openssl.exitCode, 0) << openssl.err;
        return folder / (name + ".pem");
    };
    const std::string good = made("good", "IP:127.0.0.1"), elsewhere = made("elsewhere", "DNS:elsewhere.example");
    const auto serverWith = [&](const std::string& name) {
        return Server({"--port", "0", "--tls-cert", folder / (name + ".pem"), "--tls-key", folder / (name + ".key")});
    };
    const auto attempt = [](const Server& server, const std::string& caFile) {
        connection::Options options = optionsFor(server.url());
        options.caFile = caFile;
        return std::make_unique<Viewer>(options);
    };
    const auto expectRefused = [](Viewer& viewer, const std::string& words) {
        ASSERT_TRUE(viewer.until([&] { return viewer.ended.has_value(); }));
        EXPECT_NE(viewer.ended->why.find(words), std::string::npos) << viewer.ended->why;
        EXPECT_FALSE(viewer.ended->willRetry) << "it takes a person";
    };

    const Server server = serverWith("good");
    EXPECT_TRUE(server.url().starts_with("https://")) << server.url();
    EXPECT_TRUE(attempt(server, good)->sees(1));
    expectRefused(*attempt(server, ""), "self-signed certificate");
    expectRefused(*attempt(server, elsewhere), "not trusted");
    expectRefused(*attempt(serverWith("elsewhere"), elsewhere), "name or address");
    const Server plain;
    Viewer viewer(optionsFor("https://127.0.0.1:" + plain.port()));
    ASSERT_TRUE(viewer.until([&] { return viewer.ended.has_value(); }));
    EXPECT_NE(viewer.ended->why.find("TLS"), std::string::npos) << viewer.ended->why;
}

TEST(Record, GoesOnWithTheNextServer) {
    const TemporaryFolder folder;
    const auto files = [&] { return std::distance(std::filesystem::directory_iterator(folder.path), {}); };
    const auto start = [&](const std::string& port) {
        return std::make_unique<Server>(std::vector<std::string>{"--port", port, "--record-dir", folder.path});
    };
    auto server = start("0");
    Viewer viewer(optionsFor(server->url()));
    ASSERT_TRUE(viewer.sees(1));
    viewer.connection.record(true);
    ASSERT_TRUE(viewer.until([&] { return !viewer.recording.empty(); })) << viewer.error;
    EXPECT_TRUE(std::filesystem::exists(folder / viewer.recording));
    const std::string first = std::exchange(viewer.recording, "");

    const std::string port = server->port();
    server->kill();
    server = start(port);
    ASSERT_TRUE(viewer.until([&] { return !viewer.recording.empty(); })) << viewer.error;
    EXPECT_NE(viewer.recording, first);
    EXPECT_EQ(files(), 2);
}

TEST(Follow, ShowsTheOthersSceneWithACameraOfItsOwn) {
    auto server = std::make_unique<Server>();
    Viewer leader(optionsFor(server->url()));
    ASSERT_TRUE(leader.connection.update({{"scene", {"builtin", "prism"}}}));
    ASSERT_TRUE(leader.sees(1));
    Viewer follower(optionsFor(server->url(), leader.welcome->viewId));
    ASSERT_TRUE(follower.sees(1));
    EXPECT_EQ(follower.scene(), (Json{"builtin", "prism"}));
    ASSERT_TRUE(follower.connection.input({{"camera", {{"fov_y_deg", 21.0}}}}));
    ASSERT_TRUE(leader.connection.input({{"lights", {{"key", {{"position", {-1.0, 0.5, 0.125}}}}}}}));
    ASSERT_TRUE(follower.until([&] { return follower.light() == Json{-1.0, 0.5, 0.125}; })) << follower.state;
    EXPECT_EQ(follower.state["camera"]["fov_y_deg"], 21.0);
    EXPECT_EQ(follower.error, "");

    // What is not its own it cannot change, and it stays connected.
    ASSERT_TRUE(follower.connection.update({{"outside_index", 1.2}}));
    ASSERT_TRUE(follower.until([&] { return !follower.error.empty(); }));
    EXPECT_FALSE(follower.connection.document().contains("outside_index"));

    // Another server, that knows neither: the follower shows what it saw last until the other is back.
    follower.error.clear();
    const std::string port = server->port();
    server->kill();
    ASSERT_TRUE(leader.until([&] { return leader.ended.has_value(); }));
    ASSERT_TRUE(leader.connection.input({{"lights", {{"key", {{"position", {-1.0, 0.75, 0.125}}}}}}}));
    follower.welcome.reset();
    follower.state = Json{};
    server = std::make_unique<Server>(std::vector<std::string>{"--port", port});
    ASSERT_TRUE(follower.until([&] { return follower.welcome && follower.state.is_object(); }));
    EXPECT_EQ(follower.scene(), (Json{"builtin", "prism"}));
    EXPECT_EQ(follower.state["camera"]["fov_y_deg"], 21.0);
    ASSERT_TRUE(leader.sees(1));
    ASSERT_TRUE(follower.until([&] { return follower.light() == Json{-1.0, 0.75, 0.125}; })) << follower.state;
    EXPECT_TRUE(follower.until([&] { return follower.statuses["follow"].empty(); }));
    EXPECT_TRUE(follower.sees(1));
    EXPECT_EQ(follower.error, "");
}

TEST(Follow, NobodyIsNoReasonToHammerTheServer) {
    Server server;
    Viewer viewer(optionsFor(server.url(), std::string(32, 'a')));
    ASSERT_TRUE(viewer.until([&] { return viewer.ended.has_value(); }));
    EXPECT_NE(viewer.ended->why.find("no such session"), std::string::npos) << viewer.ended->why;
    EXPECT_TRUE(viewer.ended->willRetry) << "it may come";
    EXPECT_GE(viewer.ended->waitMs, 100);
}

}  // namespace
}  // namespace caustream::e2e
