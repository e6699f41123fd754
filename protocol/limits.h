// What either side may ask of the other. The server announces its own in `welcome`; these are the defaults.
#pragma once
#include <cstddef>
#include <cstdint>

namespace caustream::protocol {

struct Limits {
    std::size_t textBytes = 64u << 10;       // a text message to the server
    std::size_t serverTextBytes = 4u << 20;  // a text message to the client: scene summaries are long
    std::size_t depth = 32;                  // nested JSON arrays and objects
    std::size_t binaryBytes = 1u << 20;      // a binary message to the server
    std::size_t chunkBytes = 256u << 10;     // payload of one CHUNK
    std::size_t creditBytes = 1u << 20;      // sent and not yet confirmed, per asset
    std::size_t assetBytes = 64u << 20;
    std::size_t stateBytes = 32u << 10;  // the state document as JSON text
    std::uint32_t frameMinSide = 16, frameMaxSide = 4096;
    std::uint32_t framePixels = 8'300'000;
    std::size_t framePayloadBytes = 256u << 20;
    std::uint32_t bands = 64;
    std::uint32_t sessions = 8;
    std::size_t viewerBytes = 1u << 30;       // estimated, of one viewer's scene, maps and pictures; beyond: busy
    std::size_t assetCacheBytes = 512u << 20; // uploaded scenes that are kept though no one shows them
    std::uint32_t gpuMsPerS = 0;              // GPU time that one viewer gets in a second; 0: no limit
    std::uint32_t messagesPerS = 300;  // per connection
    std::uint32_t helloS = 5;          // from connection to hello
    std::uint32_t pingS = 15;          // silence after which a side pings
    std::uint32_t deadS = 30;          // without an acknowledgement or a pong: closed
    std::uint32_t idlePauseS = 600, idleCloseS = 3600;
    std::uint32_t resumeS = 600;  // a session's state is kept this long after its connection ends
    bool operator==(const Limits&) const = default;
};

}  // namespace caustream::protocol
