// A WebSocket client that says whatever a test wants, right or wrong: blocking, one thread, no library in between.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/messages.h"

namespace caustream::e2e {

using protocol::Json;

struct Message {
    enum class Kind { Text, Binary, Close, Silence };
    Kind kind = Kind::Silence;
    std::string text;                  // Text; Close: the reason
    std::vector<std::uint8_t> bytes;   // Binary
    int closeCode = 0;                 // Close; 0: the connection broke
};

struct Picture {
    protocol::FrameHeader header;
    std::vector<std::uint8_t> payload;
};

// A connected TCP socket of this machine; throws std::runtime_error when nobody listens.
int connectTo(int port);

// One HTTP exchange: the answer's head and body. `extra` holds more header lines, each with its \r\n.
std::string httpGet(int port, std::string_view path, std::string_view extra = "");

// Writes `request` to a fresh connection and closes it without waiting.
void sendRequest(int port, std::string_view request);

class RawClient {
   public:
    // Connects and upgrades; throws std::runtime_error when the server will not have it. `extra` as httpGet()'s.
    explicit RawClient(int port, std::string_view path = "/ws", std::string_view extra = "");
    ~RawClient();
    RawClient(const RawClient&) = delete;
    RawClient& operator=(const RawClient&) = delete;

    void text(std::string_view message) { send(0x1, message); }
    void json(const Json& message) { text(message.dump()); }
    void binary(std::span<const std::uint8_t> message);
    void send(std::uint8_t opcode, std::string_view payload, bool final = true);
    void bytes(std::string_view raw);  // straight into the socket
    int descriptor() const { return socket_; }

    // The next message within `ms`; a ping on the way is answered.
    Message next(int ms = 60'000);

    // hello with a welcome and the first `state`; fields of `extra` go into the hello.
    Json hello(const Json& extra = Json::object());

    // Sends `message` with a fresh id and waits for its reply; frames on the way wait for frame(), other texts are dropped.
    Json ask(Json message);
    Json update(const Json& patch) { return ask({{"op", "update"}, {"patch", patch}}); }

    // Waits for a text of this op; nothing within `ms`.
    std::optional<Json> textOf(std::string_view op, int ms = 60'000);

    // Waits for a frame; of the texts on the way, stream.info goes to `infos` and statistics to `stats`.
    std::optional<Picture> frame(int ms = 60'000);
    Picture requestFrame(bool still = false, bool converge = false);
    void ack(std::uint32_t seq) { json({{"op", "ack"}, {"seq", seq}, {"recv_us", 1}, {"decode_us", 1}, {"paint_us", 1}}); }

    std::vector<Json> infos, stats;
    Json lastReply;  // of requestFrame

   private:
    bool fill(int ms);

    int socket_ = -1;
    bool ended_ = false;  // nothing more comes
    std::string received_;
    std::deque<Message> frames_;  // that came while a text was waited for
    std::uint32_t nextId_ = 1;
};

// 8-bit RGB; empty when the payload is no JPEG.
std::vector<std::uint8_t> decodeJpeg(const Picture& picture);

}  // namespace caustream::e2e
