// What a Connection tells its owner, in the order it happened.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "client/connection/image.h"
#include "protocol/messages.h"

namespace caustream::connection {

struct Disconnected {
    int closeCode = 0;  // the server's; kBadCertificate; 0: the connection could not be made, or broke
    std::string why;
    bool willRetry = true;
    int waitMs = 0;  // until then
};
struct RoundTrip {
    double ms = 0.0;
    std::uint64_t sentUs = 0, serverUs = 0, receivedUs = 0;  // of the ping and its pong; our clock, and the server's
};
struct UploadProgress {
    std::uint64_t sent = 0, size = 0;  // bytes that have arrived, of how many
};
struct BadMessage {  // what the server said could not be understood, or a frame not decoded
    std::string why;
};

using Event = std::variant<protocol::Welcome, protocol::Ok, protocol::ErrorMessage, protocol::StateMessage,
                           protocol::StreamInfo, protocol::Stats, protocol::Status, protocol::Goaway, Disconnected,
                           RoundTrip, UploadProgress, BadMessage>;

struct Frame {
    protocol::FrameHeader header;
    std::shared_ptr<const protocol::StreamInfo> info;  // of its epoch; never null
    Image image;
    std::vector<std::uint8_t> encoded;  // the payload as it came, only when it was asked for
    std::string mapHash;                // only of a frame that was requested
    std::uint64_t receivedUs = 0;       // nowUs() when its last byte was here
    std::uint32_t decodeUs = 0;
};

}  // namespace caustream::connection
