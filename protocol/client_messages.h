// What a client says. One struct per op; `id` is the client's own number (> 0) for a request that wants its reply.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <variant>
#include <vector>

#include "protocol/state.h"

namespace caustream::protocol {

inline constexpr std::string_view kSubprotocol = "caustream.v1";

enum class Role { Control, View };

struct Resume {
    std::string session;
    std::optional<Json> state;  // the client's copy of the document, for a server that has lost it
    std::optional<std::uint32_t> rev, inputSeq;
    bool operator==(const Resume&) const = default;
};

struct Hello {
    std::uint32_t id = 0;
    std::optional<std::string> token;
    std::string clientName, clientVersion;
    std::vector<std::string> caps;  // "jpeg" "png" "raw" "zstd" "shuffle" "f16" "f32"; unknown ones are ignored
    std::uint32_t maxInflight = 2;  // 1..8 frames sent and not acknowledged
    bool strict = false;            // unknown fields are errors
    Role role = Role::Control;
    std::optional<std::string> follow;  // another session's id
    std::optional<Resume> resume;
    bool operator==(const Hello&) const = default;
};

struct Update {
    std::optional<std::uint32_t> id;
    Json patch;
    bool operator==(const Update&) const = default;
};

struct Input {  // no reply; newest pose wins
    std::uint32_t seq = 0;
    std::uint64_t tUs = 0;        // client's clock
    Json patch = Json::object();  // holds `camera`, `lights`, both or neither
    bool operator==(const Input&) const = default;
};

struct StreamStart {
    std::uint32_t id = 0;
    bool stats = false;  // send `stats` once a second
    bool operator==(const StreamStart&) const = default;
};
struct StreamPause {
    std::uint32_t id = 0;
    bool operator==(const StreamPause&) const = default;
};
struct StreamResume {
    std::uint32_t id = 0;
    bool operator==(const StreamResume&) const = default;
};

struct FrameRequest {  // one frame of the present state, drawn whatever the stream does
    std::uint32_t id = 0;
    bool still = false;     // anti-aliased
    bool converge = false;  // as a frame at rest: traced, with photons added to those that there are
    bool operator==(const FrameRequest&) const = default;
};

struct Ack {  // cumulative, sent once the frame is on the screen
    std::uint32_t seq = 0;
    std::uint64_t recvUs = 0;  // client's clock
    std::uint32_t decodeUs = 0, paintUs = 0;
    bool operator==(const Ack&) const = default;
};

struct AssetBegin {
    std::uint32_t id = 0;
    std::string sha256;      // 64 lower-case hex digits
    std::uint64_t size = 0;  // bytes, > 0
    std::string mime = "model/gltf-binary";
    bool operator==(const AssetBegin&) const = default;
};
struct AssetEnd {
    std::uint32_t id = 0, asset = 0;
    bool operator==(const AssetEnd&) const = default;
};
struct AssetAbort {
    std::uint32_t asset = 0;
    bool operator==(const AssetAbort&) const = default;
};

struct Record {  // what this session says from now on goes to a file on the server
    std::uint32_t id = 0;
    bool on = true;
    bool operator==(const Record&) const = default;
};

struct Ping {
    std::uint64_t tUs = 0;
    bool operator==(const Ping&) const = default;
};

using ClientMessage = std::variant<Hello, Update, Input, StreamStart, StreamPause, StreamResume, FrameRequest, Ack,
                                   AssetBegin, AssetEnd, AssetAbort, Record, Ping>;

// Never throws. `strict`: what this connection's hello asked for.
tl::expected<ClientMessage, DecodeError> decodeClientMessage(std::string_view text, const Limits& limits = {},
                                                             bool strict = false);

std::string encode(const Hello& message);
std::string encode(const Update& message);
std::string encode(const Input& message);
std::string encode(const StreamStart& message);
std::string encode(const StreamPause& message);
std::string encode(const StreamResume& message);
std::string encode(const FrameRequest& message);
std::string encode(const Ack& message);
std::string encode(const AssetBegin& message);
std::string encode(const AssetEnd& message);
std::string encode(const AssetAbort& message);
std::string encode(const Record& message);
std::string encode(const Ping& message);
std::string encode(const ClientMessage& message);

}  // namespace caustream::protocol
