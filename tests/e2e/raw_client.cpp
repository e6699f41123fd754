#include "raw_client.h"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <turbojpeg.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>
#include <utility>

namespace caustream::e2e {
namespace {

using Clock = std::chrono::steady_clock;

void sendAll(int descriptor, std::string_view data) {
    while (!data.empty()) {
        const ssize_t sent = ::send(descriptor, data.data(), data.size(), MSG_NOSIGNAL);
        if (sent <= 0) {
            return;  // the server has closed; next() will tell
        }
        data.remove_prefix(static_cast<std::size_t>(sent));
    }
}

}  // namespace

int connectTo(int port) {
    const int descriptor = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        close(descriptor);
        throw std::runtime_error("cannot connect");
    }
    const int yes = 1;
    setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    return descriptor;
}

std::string httpGet(int port, std::string_view path, std::string_view extra) {
    const int descriptor = connectTo(port);
    sendAll(descriptor, "GET " + std::string(path) + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
                            "\r\nConnection: close\r\n" + std::string(extra) + "\r\n");
    std::string answer;
    std::array<char, 4096> buffer{};
    for (ssize_t size = 0; (size = recv(descriptor, buffer.data(), buffer.size(), 0)) > 0;) {
        answer.append(buffer.data(), static_cast<std::size_t>(size));
    }
    close(descriptor);
    return answer;
}

void sendRequest(int port, std::string_view request) {
    const int descriptor = connectTo(port);
    sendAll(descriptor, request);
    close(descriptor);
}

RawClient::RawClient(int port, std::string_view path, std::string_view extra) : socket_(connectTo(port)) {
    sendAll(socket_, "GET " + std::string(path) + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
                         "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: caustream.v1\r\n" +
                         std::string(extra) + "\r\n");
    while (received_.find("\r\n\r\n") == std::string::npos) {
        if (!fill(60'000)) {
            throw std::runtime_error("no handshake: " + received_);
        }
    }
    if (!received_.starts_with("HTTP/1.1 101")) {
        throw std::runtime_error("refused: " + received_);
    }
    received_.erase(0, received_.find("\r\n\r\n") + 4);
}

RawClient::~RawClient() { close(socket_); }

bool RawClient::fill(int ms) {
    pollfd readable = {socket_, POLLIN, 0};
    if (poll(&readable, 1, ms) <= 0) {
        return false;
    }
    std::array<char, 65536> buffer{};
    const ssize_t size = recv(socket_, buffer.data(), buffer.size(), 0);
    if (size > 0) {
        received_.append(buffer.data(), static_cast<std::size_t>(size));
    }
    ended_ = size <= 0;
    return size > 0;
}

void RawClient::bytes(std::string_view raw) { sendAll(socket_, raw); }

void RawClient::send(std::uint8_t opcode, std::string_view payload, bool final) {
    std::string frame;
    frame += static_cast<char>(opcode | (final ? 0x80 : 0));
    if (payload.size() < 126) {
        frame += static_cast<char>(0x80 | payload.size());
    } else {
        const bool wide = payload.size() > 0xffff;
        frame += static_cast<char>(0x80 | (wide ? 127 : 126));
        for (int shift = wide ? 56 : 8; shift >= 0; shift -= 8) {
            frame += static_cast<char>(payload.size() >> shift);
        }
    }
    frame.append(4, '\0');  // a mask of zeros leaves the payload as it is
    frame += payload;
    sendAll(socket_, frame);
}

void RawClient::binary(std::span<const std::uint8_t> message) {
    send(0x2, {reinterpret_cast<const char*>(message.data()), message.size()});
}

Message RawClient::next(int ms) {
    const auto last = Clock::now() + std::chrono::milliseconds(ms);
    const auto have = [&](std::size_t size) {
        while (received_.size() < size) {
            const auto left = std::chrono::ceil<std::chrono::milliseconds>(last - Clock::now()).count();
            if (!fill(static_cast<int>(std::max<std::int64_t>(left, 0)))) {
                return false;
            }
        }
        return true;
    };
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(received_[i]); };
    Message message;
    std::string payload;
    std::uint8_t opcode = 0;
    for (bool final = false; !final;) {
        if (!have(2)) {
            break;
        }
        std::size_t head = 2, size = byte(1) & 0x7f;
        const std::size_t lengthBytes = size == 126 ? 2 : size == 127 ? 8 : 0;
        if (!have(head + lengthBytes)) {
            break;
        }
        if (lengthBytes > 0) {
            size = 0;
            for (std::size_t i = 0; i < lengthBytes; ++i) {
                size = size << 8 | byte(head + i);
            }
            head += lengthBytes;
        }
        if (!have(head + size)) {
            break;
        }
        const std::uint8_t piece = byte(0) & 0x0f;
        final = byte(0) & 0x80;
        if (piece >= 0x9) {  // ping, pong
            if (piece == 0x9) {
                send(0xa, std::string_view(received_).substr(head, size));
            }
            received_.erase(0, head + size);
            final = false;
            continue;
        }
        opcode = piece ? piece : opcode;
        payload.append(received_, head, size);
        received_.erase(0, head + size);
        if (final) {
            message.kind = opcode == 1 ? Message::Kind::Text : opcode == 2 ? Message::Kind::Binary : Message::Kind::Close;
        }
    }
    if (message.kind == Message::Kind::Silence) {
        if (ended_) {
            message.kind = Message::Kind::Close;
        }
    } else if (message.kind == Message::Kind::Binary) {
        message.bytes.assign(payload.begin(), payload.end());
    } else if (message.kind == Message::Kind::Close) {
        message.closeCode =
            payload.size() >= 2 ? static_cast<std::uint8_t>(payload[0]) << 8 | static_cast<std::uint8_t>(payload[1]) : 1005;
        message.text = payload.size() > 2 ? payload.substr(2) : "";
    } else {
        message.text = payload;
    }
    return message;
}

std::optional<Json> RawClient::textOf(std::string_view op, int ms) {
    const auto last = Clock::now() + std::chrono::milliseconds(ms);
    while (Clock::now() < last) {
        Message message = next(ms);
        if (message.kind == Message::Kind::Close || message.kind == Message::Kind::Silence) {
            return std::nullopt;
        }
        if (message.kind == Message::Kind::Binary) {
            frames_.push_back(std::move(message));
            continue;
        }
        if (Json json = Json::parse(message.text); json.value("op", "") == op) {
            return json;
        }
    }
    return std::nullopt;
}

Json RawClient::hello(const Json& extra) {
    Json message = {{"op", "hello"},
                    {"id", nextId_++},
                    {"client", {{"name", "test"}, {"version", "1"}}},
                    {"caps", {"jpeg", "raw", "f16", "f32"}},
                    {"max_inflight", 2}};
    message.update(extra);
    json(message);
    const auto welcome = textOf("welcome");
    if (!welcome) {
        throw std::runtime_error("no welcome");
    }
    if (!textOf("state")) {
        throw std::runtime_error("no state");
    }
    return *welcome;
}

Json RawClient::ask(Json message) {
    const std::uint32_t id = nextId_++;
    message["id"] = id;
    json(message);
    while (true) {
        Message reply = next();
        if (reply.kind == Message::Kind::Close || reply.kind == Message::Kind::Silence) {
            throw std::runtime_error("no reply to " + message.dump());
        }
        if (reply.kind == Message::Kind::Binary) {
            frames_.push_back(std::move(reply));
            continue;
        }
        const Json answer = Json::parse(reply.text);
        if (answer.value("id", 0u) == id) {
            return answer;
        }
        if (answer.value("op", "") == "stream.info") {
            infos.push_back(answer);
        }
    }
}

std::optional<Picture> RawClient::frame(int ms) {
    const auto last = Clock::now() + std::chrono::milliseconds(ms);
    while (Clock::now() < last) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(last - Clock::now()).count();
        Message message;
        if (frames_.empty()) {
            message = next(static_cast<int>(left));
        } else {
            message = std::move(frames_.front());
            frames_.pop_front();
        }
        if (message.kind == Message::Kind::Text) {
            const Json answer = Json::parse(message.text);
            if (answer.value("op", "") == "stream.info") {
                infos.push_back(answer);
            } else if (answer.value("op", "") == "stats") {
                stats.push_back(answer);
            } else if (answer.value("op", "") == "ok") {
                lastReply = answer;
            } else if (answer.value("op", "") == "error") {
                throw std::runtime_error("an error instead of a frame: " + message.text);
            }
        } else if (message.kind == Message::Kind::Binary) {
            const auto header = protocol::decodeFrameHeader(message.bytes);
            if (!header) {
                throw std::runtime_error("frame header: " + header.error().message);
            }
            return Picture{*header, {message.bytes.begin() + header->headerLen, message.bytes.end()}};
        } else {
            return std::nullopt;
        }
    }
    return std::nullopt;
}

Picture RawClient::requestFrame(bool still, bool converge) {
    json({{"op", "frame.request"}, {"id", nextId_++}, {"still", still}, {"converge", converge}});
    auto picture = frame();
    if (!picture) {
        throw std::runtime_error("no frame");
    }
    return std::move(*picture);
}

std::vector<std::uint8_t> decodeJpeg(const Picture& picture) {
    std::vector<std::uint8_t> rgb(std::size_t{picture.header.width} * picture.header.height * 3);
    const tjhandle decoder = tjInitDecompress();
    const int result = tjDecompress2(decoder, picture.payload.data(), picture.payload.size(), rgb.data(), picture.header.width, 0,
                                     picture.header.height, TJPF_RGB, 0);
    tjDestroy(decoder);
    return result == 0 ? rgb : std::vector<std::uint8_t>{};
}

}  // namespace caustream::e2e
