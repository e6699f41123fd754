// What an operator sees and does: options from a file, health, metrics, the drain, the watchdog, systemd's notices.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "raw_client.h"
#include "server_process.h"

namespace caustream::e2e {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const Json kSmall = {{"transport", {{"photon_grid", 64}, {"map_size", 64}}}, {"stream", {{"width", 64}, {"height", 64}}}};

std::string temporary(const std::string& name, const std::string& text) {
    const std::string path = (std::filesystem::path(testing::TempDir()) / name).string();
    std::ofstream(path) << text;
    return path;
}

// The value of a metric of this name and labels; NaN where there is none.
double metric(const std::string& page, const std::string& name) {
    const std::size_t at = page.find("\n" + name + " ");
    return at == std::string::npos ? std::nan("") : std::stod(page.substr(at + name.size() + 2));
}

TEST(Operation, OptionsComeFromAFileAndFlagsWin) {
    const std::string file = temporary("caustream-some.toml", "max-sessions = 3\nserver-id = \"file\"\nallow-origin = [\"https://a.example\", \"https://b.example\"]\n");
    ServerProcess server({"--config", file, "--server-id", "flag"});
    RawClient viewer(server.port(), "/ws", "Origin: https://b.example\r\n");
    const Json welcome = viewer.hello();
    EXPECT_EQ(welcome["server"], "flag");
    EXPECT_EQ(welcome["limits"]["sessions"], 3);
}

TEST(Operation, AFileThatDoesNotHold) {
    const auto told = [](const std::string& text) { return runServer({"--config", temporary("caustream-bad.toml", text)}); };
    const Ended unknown = told("max-sessions = 3\nmax-sesions = 4\n");
    EXPECT_EQ(unknown.exitCode, 1);
    EXPECT_THAT(unknown.err, HasSubstr("\"max-sesions\""));
    EXPECT_THAT(unknown.err, HasSubstr("caustream-bad.toml"));
    EXPECT_THAT(told("max-sessions = 300\n").err, HasSubstr("max-sessions"));
    EXPECT_THAT(told("plan = \"gem\"\n").err, HasSubstr("plan"));
    EXPECT_THAT(told("bind = \"0.0.0.0\"\n").err, HasSubstr("--token-file"));
    EXPECT_THAT(told("tls-cert = \"/dev/null\"\n").err, HasSubstr("tls-"));
    EXPECT_THAT(told("allow-origin = \"example.org\"\n").err, HasSubstr("https://example.org"));
    EXPECT_THAT(runServer({"--config", "/no/such/file.toml"}).err, HasSubstr("/no/such/file.toml"));
}

TEST(Operation, TheExampleNamesEveryOption) {
    std::ifstream file(CAUSTREAM_DEPLOY "/caustream.toml");
    std::set<std::string> named, known;
    const std::regex line("#([a-z-]+) = .*"), option("--([a-z-]+)( |,|$)");
    for (std::string text; std::getline(file, text);) {
        if (std::smatch match; std::regex_match(text, match, line)) {
            named.insert(match[1]);
        }
    }
    std::istringstream help(runServer({"--help"}).out);
    for (std::string text; std::getline(help, text);) {
        if (std::smatch match; text.starts_with("  --") && std::regex_search(text, match, option)) {
            known.insert(match[1]);
        }
    }
    for (const char* commandOnly : {"help", "config", "plan", "set"}) {
        known.erase(commandOnly);
    }
    EXPECT_EQ(named, known);
}

TEST(Operation, TheUnitIsOneThatSystemdTakes) {
    std::stringstream text;
    text << std::ifstream(CAUSTREAM_DEPLOY "/caustream.service").rdbuf();
    const std::string program = "/usr/bin/caustream-server";
    std::string unit = text.str();
    ASSERT_NE(unit.find("ExecStart=" + program), std::string::npos);
    unit.replace(unit.find(program), program.size(), CAUSTREAM_SERVER);
    EXPECT_EQ(std::system(("systemd-analyze verify --man=no " + temporary("caustream.service", unit)).c_str()), 0);
}

TEST(Operation, MetricsAreWhatPrometheusReads) {
    ServerProcess server;
    RawClient viewer(server.port());
    viewer.hello();
    viewer.update(kSmall);
    viewer.requestFrame();
    viewer.update({{"camera", {{"fov_y_deg", 40}}}});
    viewer.requestFrame();
    RawClient idle(server.port());
    const std::string answer = httpGet(server.port(), "/metrics");
    const std::string page = answer.substr(answer.find("\r\n\r\n") + 4);
    EXPECT_EQ(metric(page, "caustream_frames_rendered_total"), 2);
    EXPECT_EQ(metric(page, "caustream_light_runs_total"), 1);
    EXPECT_EQ(metric(page, "caustream_light_reuses_total"), 1) << "only the camera moved";
    EXPECT_EQ(metric(page, "caustream_render_seconds_count"), 2);
    EXPECT_EQ(metric(page, "caustream_viewers{state=\"connecting\"}"), 1);
    EXPECT_EQ(metric(page, "caustream_viewers{state=\"paused\"}"), 1);
    EXPECT_EQ(metric(page, "caustream_received_messages_total{kind=\"text\"}"), 5);
    EXPECT_GT(metric(page, "caustream_gl_objects"), 0);
    EXPECT_GT(metric(page, "process_resident_memory_bytes"), 1e6);
    EXPECT_GT(metric(page, "process_open_fds"), 3);
    EXPECT_NEAR(metric(page, "process_start_time_seconds"), static_cast<double>(std::time(nullptr)), 3600);
    const std::string file = temporary("caustream-metrics.txt", page);
    EXPECT_EQ(std::system(("PATH=\"$PATH:" CAUSTREAM_TOOLS "\" promtool check metrics < " + file).c_str()), 0)
        << "promtool has a complaint, or is missing: scripts/setup.sh --tests brings it";
}

// Of 1000 bytes, never acknowledged by themselves: a stream that fills its window.
const std::vector<std::string> kNoise = {"--test-frame-bytes", "1000"};

std::vector<std::string> withNoise(std::vector<std::string> more) {
    more.insert(more.end(), kNoise.begin(), kNoise.end());
    return more;
}

// A stream with a frame on its way that is not acknowledged.
std::uint32_t startStream(RawClient& viewer) {
    viewer.hello();
    viewer.ask({{"op", "stream.start"}});
    const auto frame = viewer.frame();
    return frame ? frame->header.frameSeq : 0;
}

int closeCodeOf(RawClient& client) {
    while (true) {
        const Message message = client.next(30'000);
        if (message.kind == Message::Kind::Close || message.kind == Message::Kind::Silence) {
            return message.closeCode;
        }
    }
}

TEST(Operation, ADrainWaitsForWhatIsOnItsWay) {
    ServerProcess server(withNoise({"--drain-s", "60"}));
    RawClient slow(server.port()), idle(server.port());
    const std::uint32_t seq = startStream(slow);
    idle.hello();
    kill(server.pid(), SIGTERM);
    const auto goaway = idle.textOf("goaway");
    ASSERT_TRUE(goaway);
    EXPECT_EQ((*goaway)["reason"], "drain");
    EXPECT_GT((*goaway)["reconnect_ms"], 0);
    EXPECT_EQ(closeCodeOf(idle), 1001);
    EXPECT_THAT(httpGet(server.port(), "/healthz"), StartsWith("HTTP/1.1 404"));
    EXPECT_THAT(httpGet(server.port(), "/readyz"), StartsWith("HTTP/1.1 503"));
    EXPECT_THAT(httpGet(server.port(), "/livez"), StartsWith("HTTP/1.1 200"));
    RawClient late(server.port());
    EXPECT_EQ(closeCodeOf(late), 1001) << "no new sessions";
    ASSERT_TRUE(slow.textOf("goaway"));
    slow.ack(seq);
    Message last;
    while ((last = slow.next()).kind != Message::Kind::Close && last.kind != Message::Kind::Silence) {
        if (last.kind == Message::Kind::Binary) {  // what was drawn before
            slow.ack(protocol::decodeFrameHeader(last.bytes)->frameSeq);
        }
    }
    EXPECT_EQ(last.closeCode, 1001);
    EXPECT_EQ(server.wait().exitCode, 0);
}

TEST(Operation, ADrainEndsInTime) {
    ServerProcess server(withNoise({"--drain-s", "3"}));
    RawClient silent(server.port());
    startStream(silent);
    const Ended ended = server.stop();
    EXPECT_EQ(ended.exitCode, 0) << ended.err;
    EXPECT_EQ(closeCodeOf(silent), 1001);
}

TEST(Operation, ASecondSignalEndsAtOnce) {
    ServerProcess server(withNoise({"--drain-s", "3600"}));
    RawClient silent(server.port());
    startStream(silent);
    kill(server.pid(), SIGTERM);
    ASSERT_TRUE(silent.textOf("goaway"));
    kill(server.pid(), SIGTERM);
    EXPECT_EQ(server.wait().exitCode, 0);
}

TEST(Operation, AtATerminalItEndsSoon) {
    ServerProcess server(withNoise({"--drain-s", "3600"}));
    RawClient silent(server.port());
    startStream(silent);
    kill(server.pid(), SIGINT);
    const auto goaway = silent.textOf("goaway");
    ASSERT_TRUE(goaway);
    EXPECT_EQ((*goaway)["reason"], "shutdown");
    EXPECT_EQ(server.wait().exitCode, 0);
}

TEST(Operation, AFrameThatHangsEndsTheProgram) {
    ServerProcess server({"--watchdog-s", "1", "--test-hang-after-frames", "1"});
    RawClient viewer(server.port()), other(server.port());
    viewer.hello();
    other.hello();
    viewer.update(kSmall);
    viewer.requestFrame();
    viewer.json({{"op", "frame.request"}, {"id", 99}, {"still", false}});
    const auto status = other.textOf("status");
    ASSERT_TRUE(status);
    EXPECT_EQ((*status)["level"], "error");
    EXPECT_EQ((*status)["key"], "gpu");
    EXPECT_THAT(httpGet(server.port(), "/healthz"), StartsWith("HTTP/1.1 503"));
    const Ended ended = server.wait();
    EXPECT_EQ(ended.exitCode, 70) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("event=failed"));
}

TEST(Operation, ALostGpuEndsTheProgram) {
    ServerProcess server({"--test-lose-gpu-after-frames", "1"});
    RawClient viewer(server.port());
    viewer.hello();
    viewer.update(kSmall);
    viewer.requestFrame();
    const auto status = viewer.textOf("status");
    ASSERT_TRUE(status);
    EXPECT_EQ((*status)["key"], "gpu");
    EXPECT_EQ(closeCodeOf(viewer), 4500);
    EXPECT_EQ(server.wait().exitCode, 70);
}

TEST(Operation, SystemdIsTold) {
    const std::string path = (std::filesystem::path(testing::TempDir()) / ("caustream-notify-" + std::to_string(getpid()))).string();
    const int listener = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_un address{.sun_family = AF_UNIX};
    ASSERT_LT(path.size(), sizeof address.sun_path);
    path.copy(address.sun_path, path.size());
    ASSERT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    const timeval patience{.tv_sec = 30};
    setsockopt(listener, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    const auto heard = [&](std::string_view wanted) {
        char text[256];
        for (ssize_t size = 0; (size = recv(listener, text, sizeof text, 0)) > 0;) {
            if (std::string_view(text, static_cast<std::size_t>(size)).starts_with(wanted)) {
                return true;
            }
        }
        return false;
    };
    setenv("NOTIFY_SOCKET", path.c_str(), 1);
    ServerProcess server;
    unsetenv("NOTIFY_SOCKET");
    EXPECT_TRUE(heard("READY=1"));
    EXPECT_TRUE(heard("WATCHDOG=1"));
    kill(server.pid(), SIGTERM);
    EXPECT_TRUE(heard("STOPPING=1"));
    EXPECT_EQ(server.wait().exitCode, 0);
    close(listener);
    unlink(path.c_str());
}

}  // namespace
}  // namespace caustream::e2e
