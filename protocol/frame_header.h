// Headers of the two binary messages, little-endian: FRAME (server to client) and CHUNK (client to server).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tl/expected.hpp>

#include "protocol/errors.h"
#include "protocol/limits.h"
#include "protocol/state.h"

namespace caustream::protocol {

inline constexpr std::size_t kFrameHeaderBytes = 80, kChunkHeaderBytes = 24;
inline constexpr std::uint8_t kFrameOp = 1, kChunkOp = 2, kHeaderVersion = 1;

enum class Layout : std::uint8_t { Interleaved = 0, Planar = 1, PlanarShuffle = 2 };

enum FrameFlag : std::uint32_t {
    kFrameStill = 1,      // drawn with anti-aliasing, or asked for by frame.request
    kFrameScaled = 2,     // smaller than the view
    kFrameConverged = 4,  // a traced map at its target error: the last frame of its state, and always a still
    kFrameTest = 8,
};

struct FrameHeader {
    std::uint16_t headerLen = kFrameHeaderBytes;  // decoded: where the payload starts
    std::uint32_t frameSeq = 1;                   // 1 at first, +1 per frame sent on this connection
    std::uint16_t stream = 0, epoch = 0;
    Target target = Target::Composite;
    Encoding encoding = Encoding::Jpeg;
    Sample sample = Sample::U8;
    Layout layout = Layout::Interleaved;
    std::uint32_t flags = 0;                      // of FrameFlag; others are ignored
    std::uint16_t width = 0, height = 0;          // of the payload's picture
    std::uint16_t viewWidth = 0, viewHeight = 0;  // that it is shown at
    std::uint16_t bands = 3;
    std::uint8_t jpegQuality = 0;  // 0: not a JPEG
    std::uint8_t level = 255;      // of the quality ladder; 255: fixed
    std::uint32_t inputSeq = 0;    // newest input that the picture shows; 0: none
    std::uint32_t stateRev = 0;
    std::uint64_t clientUs = 0;  // t_us of that input
    std::uint64_t serverUs = 0;  // server's monotonic clock when handed to the socket
    std::uint32_t holdUs = 0, renderUs = 0, encodeUs = 0;
    std::uint32_t payloadLen = 0;  // bytes after the header
    std::uint32_t rawLen = 0;      // bytes of the decoded samples
    float scale = 1.0f;            // value = sample * scale
    bool operator==(const FrameHeader&) const = default;
};

struct ChunkHeader {
    std::uint16_t headerLen = kChunkHeaderBytes;
    std::uint32_t asset = 0;
    std::uint64_t offset = 0;  // bytes of the asset sent before this chunk
    std::uint32_t payloadLen = 0;
    std::uint32_t crc32 = 0;  // of the payload, as zlib's crc32(); checked by whoever stores it
    bool operator==(const ChunkHeader&) const = default;
};

std::size_t sampleBytes(Sample sample);  // 1, 2, 4

std::array<std::uint8_t, kFrameHeaderBytes> encodeHeader(const FrameHeader& header);
std::array<std::uint8_t, kChunkHeaderBytes> encodeHeader(const ChunkHeader& header);

// `message` is the whole binary message. On success message.subspan(headerLen, payloadLen) is the payload and ends the
// message; the sizes in the header agree with each other and with `limits`.
tl::expected<FrameHeader, DecodeError> decodeFrameHeader(std::span<const std::uint8_t> message,
                                                         const Limits& limits = {});
tl::expected<ChunkHeader, DecodeError> decodeChunkHeader(std::span<const std::uint8_t> message,
                                                         const Limits& limits = {});

}  // namespace caustream::protocol
