// https and wss with a given certificate; plain http on the same port is told so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "../raw_client.h"
#include "error.h"
#include "lone_port.h"

namespace caustream::e2e {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string run(const std::string& command) {
    std::string output;
    FILE* pipe = popen(command.c_str(), "r");
    for (int c = 0; pipe && (c = std::fgetc(pipe)) != EOF;) {
        output += static_cast<char>(c);
    }
    pclose(pipe);
    return output;
}

class Tls : public testing::Test {
   protected:
    Tls() {
        run("openssl req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=localhost -addext subjectAltName=DNS:localhost -keyout " +
            key_ + " -out " + certificate_ + " 2>&1");
    }

    net::ServerOptions options() const { return {.tlsCert = certificate_, .tlsKey = key_}; }

    // What openssl's client gets for `request`, checking the certificate; "" when there is no connection.
    std::string ask(int port, const std::string& request, const std::string& version, int mostS = 20) const {
        return run("(printf '" + request + "'; sleep 1) | timeout " + std::to_string(mostS) + " openssl s_client -quiet -verify_return_error -verify_hostname localhost -CAfile " +
                   certificate_ + " " + version + " -connect 127.0.0.1:" + std::to_string(port) + " 2>/dev/null");
    }

    std::string folder_ = testing::TempDir();
    std::string certificate_ = (std::filesystem::path(folder_) / "caustream-cert.pem").string();
    std::string key_ = (std::filesystem::path(folder_) / "caustream-key.pem").string();
};

TEST_F(Tls, PagesAndWebSockets) {
    LonePort port(options());
    const std::string get = "GET /hello HTTP/1.1\\r\\nHost: localhost\\r\\nConnection: close\\r\\n\\r\\n";
    EXPECT_THAT(ask(port.port(), get, "-tls1_3"), HasSubstr("/hello"));
    EXPECT_THAT(ask(port.port(), get, "-tls1_2"), HasSubstr("/hello"));
    EXPECT_THAT(ask(port.port(), get, "-tls1_1 -cipher DEFAULT@SECLEVEL=0"), Not(HasSubstr("/hello"))) << "too old a TLS";
    const std::string upgrade =
        "GET /ws HTTP/1.1\\r\\nHost: localhost\\r\\nConnection: Upgrade\\r\\nUpgrade: websocket\\r\\nSec-WebSocket-Version: 13\\r\\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\\r\\nSec-WebSocket-Protocol: caustream.v1\\r\\nOrigin: https://localhost\\r\\n\\r\\n";
    EXPECT_THAT(ask(port.port(), upgrade, "-tls1_3", 5), HasSubstr("101 Switching Protocols"));
    EXPECT_TRUE(LonePort::eventually([&] { return port.openings == 1 && port.closings == 1; }));
}

TEST_F(Tls, PlainHttpIsTold) {
    LonePort port(options());
    EXPECT_THAT(httpGet(port.port(), "/hello"), HasSubstr("https://"));
    EXPECT_THROW(RawClient(port.port()), std::runtime_error);
    EXPECT_EQ(port.openings, 0);
}

TEST_F(Tls, AHandshakeThatNeverEnds) {
    LonePort port(options());
    const int silent = connectTo(port.port());
    ASSERT_TRUE(LonePort::eventually([&] { return port.counts().open == 1; }));
    EXPECT_TRUE(LonePort::eventually([&] { return port.counts().open == 0; }));
    EXPECT_THAT(ask(port.port(), "GET /hello HTTP/1.1\\r\\nHost: localhost\\r\\nConnection: close\\r\\n\\r\\n", ""), HasSubstr("/hello"));
    close(silent);
}

TEST_F(Tls, FilesThatAreNoCertificate) {
    std::FILE* file = std::fopen(key_.c_str(), "w");
    std::fputs("no key\n", file);
    std::fclose(file);
    EXPECT_THROW(LonePort{options()}, Error);
}

}  // namespace
}  // namespace caustream::e2e
