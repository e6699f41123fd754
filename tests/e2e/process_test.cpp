// The program around the server: its start, its end, its one-line errors and its plain HTTP pages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "raw_client.h"
#include "server_process.h"

namespace caustream::e2e {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// One line that says what, where and what to try; exit code 1.
void expectOneLine(const Ended& ended, const std::string& part) {
    EXPECT_EQ(ended.exitCode, 1);
    std::string line;
    std::istringstream lines(ended.err);
    int count = 0;
    for (std::string each; std::getline(lines, each);) {
        if (each.starts_with("caustream-server: ")) {
            line = each;
            ++count;
        }
    }
    EXPECT_EQ(count, 1) << ended.err;
    EXPECT_THAT(line, HasSubstr(part));
    EXPECT_TRUE(ended.out.empty()) << ended.out;
}

TEST(Process, SaysReadyAndEndsCleanly) {
    ServerProcess server;
    EXPECT_EQ(server.readyLine(), "ready http://127.0.0.1:" + std::to_string(server.port()) + "/\n");
    RawClient viewer(server.port());
    viewer.hello();
    const Ended ended = server.stop();
    EXPECT_EQ(ended.exitCode, 0) << ended.err;
    const auto goaway = viewer.textOf("goaway", 5000);
    ASSERT_TRUE(goaway);
    EXPECT_EQ((*goaway)["reason"], "drain");
    EXPECT_EQ(viewer.next().closeCode, 1001);
}

TEST(Process, PortInUse) {
    ServerProcess server;
    const Ended ended = runServer({"--port", std::to_string(server.port())});
    expectOneLine(ended, std::to_string(server.port()));
    EXPECT_THAT(ended.err, HasSubstr("--port 0"));
}

TEST(Process, OptionsThatMakeNoSense) {
    expectOneLine(runServer({"--port", "banana"}), "port");
    expectOneLine(runServer({"--dance"}), "--help");
    expectOneLine(runServer({"--port", "0", "--bind", "0.0.0.0"}), "--token-file");
    expectOneLine(runServer({"--port", "0", "--bind", "127.0.0.1", "--token-file", "/no/such/file"}), "/no/such/file");
    expectOneLine(runServer({"--port", "0", "--shader-dir", "/no/such/folder"}), "/no/such/folder");
    expectOneLine(runServer({"--port", "0", "--gpu", "no such gpu"}), "no such gpu");
    expectOneLine(runServer({"--log-level", "loud"}), "loud");
}

TEST(Process, HelpTeaches) {
    const Ended ended = runServer({"--help"});
    EXPECT_EQ(ended.exitCode, 0);
    EXPECT_THAT(ended.out, HasSubstr("--port"));
    EXPECT_THAT(ended.out, HasSubstr("browser"));
}

TEST(Process, TellsAScenesPlan) {
    const Ended gem = runServer({"--plan", "gem"});
    EXPECT_EQ(gem.exitCode, 0) << gem.err;
    EXPECT_THAT(gem.out, HasSubstr("run   photon_paths"));
    EXPECT_THAT(gem.out, HasSubstr("skip  photon_paths"));   // after the camera moved
    EXPECT_THAT(gem.out, HasSubstr("skip  picture_mean"));
    EXPECT_THAT(gem.out, HasSubstr("run   picture_mean"));   // at rest
    EXPECT_THAT(gem.out, HasSubstr("unchanged"));
    const Ended dark = runServer({"--plan", "sphere", "--set", "lights.key.direction=[0,1,0]", "--set", "stream.target=spectral"});
    EXPECT_THAT(dark.out, HasSubstr("the light reaches no caster"));
    EXPECT_THAT(dark.out, HasSubstr("skip  camera_receivers"));
    expectOneLine(runServer({"--plan", "no such scene"}), "gem");
    expectOneLine(runServer({"--plan", "/no/such/file.glb"}), "/no/such/file.glb");
    expectOneLine(runServer({"--plan", "gem", "--set", "camera.fov_y_deg=900"}), "camera.fov_y_deg");
    expectOneLine(runServer({"--plan", "gem", "--set", "nonsense"}), "PATH=VALUE");
    expectOneLine(runServer({"--set", "camera.fov_y_deg=30"}), "--plan");
}

TEST(Process, AShaderThatDoesNotCompile) {
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "broken_shaders";
    std::filesystem::remove_all(folder);
    std::filesystem::copy(CAUSTREAM_SHADERS, folder, std::filesystem::copy_options::recursive);
    {
        std::ofstream file(folder / "passes" / "photon_trace.comp", std::ios::app);
        file << "\nvoid broken( {\n";
    }
    expectOneLine(runServer({"--port", "0", "--shader-dir", folder.string()}), "photon_trace.comp");
    std::filesystem::remove_all(folder);
}

TEST(Process, TokenIsAskedFor) {
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "token.txt";
    std::ofstream(file) << "0123456789abcdef0123\n";
    ServerProcess server({"--token-file", file.string()});
    RawClient right(server.port());
    right.hello({{"token", "0123456789abcdef0123"}});
    RawClient wrong(server.port());
    EXPECT_THROW(wrong.hello({{"token", "0123456789abcdef0124"}}), std::runtime_error);
    RawClient none(server.port());
    EXPECT_THROW(none.hello(), std::runtime_error);
    std::filesystem::remove(file);
}

TEST(Process, HttpPages) {
    ServerProcess server;
    const std::string page = httpGet(server.port(), "/");
    EXPECT_THAT(page, StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(page, HasSubstr("content-type: text/html"));
    EXPECT_THAT(page, HasSubstr("content-security-policy: default-src 'none'"));
    const std::size_t etag = page.find("etag: ");
    ASSERT_NE(etag, std::string::npos);
    const std::string tag = page.substr(etag + 6, page.find('\r', etag) - etag - 6);
    EXPECT_THAT(httpGet(server.port(), "/", "If-None-Match: " + tag + "\r\n"), StartsWith("HTTP/1.1 304"));
    EXPECT_THAT(httpGet(server.port(), "/app.js"), HasSubstr("text/javascript"));
    EXPECT_THAT(httpGet(server.port(), "/../etc/passwd"), StartsWith("HTTP/1.1 404"));
    EXPECT_THAT(httpGet(server.port(), "/livez"), HasSubstr("no-store"));
    EXPECT_THAT(httpGet(server.port(), "/healthz"), StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(httpGet(server.port(), "/readyz"), StartsWith("HTTP/1.1 200"));
    const std::string metrics = httpGet(server.port(), "/metrics");
    EXPECT_THAT(metrics, HasSubstr("caustream_sessions 0"));
    EXPECT_THAT(metrics, HasSubstr("caustream_build_info{version="));
}

TEST(Process, WhoMayUpgrade) {
    ServerProcess server;
    const std::string upgrade =
        "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
    const std::string ours = upgrade + "Sec-WebSocket-Protocol: caustream.v1\r\n";
    EXPECT_THAT(httpGet(server.port(), "/ws", ours + "Origin: http://evil.example\r\n"), HasSubstr(" 403 "));
    EXPECT_THAT(httpGet(server.port(), "/elsewhere", ours), HasSubstr(" 404 "));
    EXPECT_THAT(httpGet(server.port(), "/ws", upgrade), HasSubstr(" 400 ")) << "no subprotocol";
    EXPECT_THAT(httpGet(server.port(), "/", "Upgrade: h2c\r\nHTTP2-Settings: AAMAAABkAAQAAP__\r\n"), HasSubstr(" 400 "));
    RawClient viewer(server.port());
    viewer.hello();
}

}  // namespace
}  // namespace caustream::e2e
