// The binary headers: golden bytes, every truncation, and headers that lie.
#include "protocol/frame_header.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace caustream::protocol {
namespace {

using Bytes = std::vector<std::uint8_t>;

FrameHeader sampleFrame() {
    FrameHeader header;
    header.frameSeq = 0x04030201;
    header.stream = 0x0605;
    header.epoch = 0x0807;
    header.target = Target::Spectral;
    header.encoding = Encoding::Raw;
    header.sample = Sample::F16;
    header.layout = Layout::Planar;
    header.flags = kFrameStill | kFrameScaled;
    header.width = 4;
    header.height = 3;
    header.viewWidth = 0x0120;
    header.viewHeight = 0x0110;
    header.bands = 2;
    header.jpegQuality = 90;
    header.level = 255;
    header.inputSeq = 0x14131211;
    header.stateRev = 0x18171615;
    header.clientUs = 0x2827262524232221;
    header.serverUs = 0x3837363534333231;
    header.holdUs = 0x44434241;
    header.renderUs = 0x48474645;
    header.encodeUs = 0x54535251;
    header.payloadLen = 48;
    header.rawLen = 48;
    header.scale = 2.0f;
    return header;
}

ChunkHeader sampleChunk() {
    return {kChunkHeaderBytes, 0x04030201, 0x0102030, 5, 0xdeadbeef};
}

template <class Header>
Bytes message(const Header& header) {
    const auto start = encodeHeader(header);
    Bytes bytes(start.begin(), start.end());
    bytes.resize(bytes.size() + header.payloadLen, 0xab);
    return bytes;
}

TEST(FrameHeader, HasItsGoldenBytes) {
    const Bytes golden = {
        0x01, 0x01, 0x50, 0x00, 0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x07, 0x08, 0x02, 0x02, 0x02, 0x01,  //
        0x03, 0x00, 0x00, 0x00, 0x04, 0x00, 0x03, 0x00, 0x20, 0x01, 0x10, 0x01, 0x02, 0x00, 0x5a, 0xff,  //
        0x11, 0x12, 0x13, 0x14, 0x15, 0x16, 0x17, 0x18, 0x21, 0x22, 0x23, 0x24, 0x25, 0x26, 0x27, 0x28,  //
        0x31, 0x32, 0x33, 0x34, 0x35, 0x36, 0x37, 0x38, 0x41, 0x42, 0x43, 0x44, 0x45, 0x46, 0x47, 0x48,  //
        0x51, 0x52, 0x53, 0x54, 0x30, 0x00, 0x00, 0x00, 0x30, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x40,
    };
    const auto bytes = encodeHeader(sampleFrame());
    EXPECT_EQ(Bytes(bytes.begin(), bytes.end()), golden);
    const auto decoded = decodeFrameHeader(message(sampleFrame()));
    ASSERT_TRUE(decoded.has_value()) << decoded.error().field;
    EXPECT_EQ(*decoded, sampleFrame());
}

TEST(ChunkHeader, HasItsGoldenBytes) {
    const Bytes golden = {0x02, 0x01, 0x18, 0x00, 0x01, 0x02, 0x03, 0x04, 0x30, 0x20, 0x10, 0x00,
                          0x00, 0x00, 0x00, 0x00, 0x05, 0x00, 0x00, 0x00, 0xef, 0xbe, 0xad, 0xde};
    const auto bytes = encodeHeader(sampleChunk());
    EXPECT_EQ(Bytes(bytes.begin(), bytes.end()), golden);
    const auto decoded = decodeChunkHeader(message(sampleChunk()));
    ASSERT_TRUE(decoded.has_value()) << decoded.error().field;
    EXPECT_EQ(*decoded, sampleChunk());
}

TEST(FrameHeader, EveryTruncationIsRefused) {
    const Bytes whole = message(sampleFrame());
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_FALSE(decodeFrameHeader(std::span(whole).first(length)).has_value()) << length;
    // The same from a block of exactly that size, so that a sanitizer sees a read past it.
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_FALSE(decodeFrameHeader(Bytes(whole.begin(), whole.begin() + std::ptrdiff_t(length))).has_value());
}

TEST(ChunkHeader, EveryTruncationIsRefused) {
    const Bytes whole = message(sampleChunk());
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_FALSE(decodeChunkHeader(Bytes(whole.begin(), whole.begin() + std::ptrdiff_t(length))).has_value());
}

TEST(FrameHeader, ALongerHeaderIsSkipped) {
    Bytes bytes = message(sampleFrame());
    bytes.insert(bytes.begin() + 80, 16, 0x77);
    bytes[2] = 96;
    const auto decoded = decodeFrameHeader(bytes);
    ASSERT_TRUE(decoded.has_value());
    EXPECT_EQ(decoded->headerLen, 96);
    EXPECT_EQ(bytes[decoded->headerLen], 0xab);
}

TEST(FrameHeader, AWrongStartIsNamed) {
    const auto fieldWith = [](std::size_t offset, std::uint8_t value) {
        Bytes bytes = message(sampleFrame());
        bytes[offset] = value;
        const auto decoded = decodeFrameHeader(bytes);
        EXPECT_FALSE(decoded.has_value());
        return decoded ? std::string() : decoded.error().field;
    };
    EXPECT_EQ(fieldWith(0, 2), "op");
    EXPECT_EQ(fieldWith(1, 2), "header_version");
    for (std::uint8_t length : {0, 72, 79, 81, 84, 136}) EXPECT_EQ(fieldWith(2, length), "header_len") << int(length);
    EXPECT_EQ(fieldWith(3, 0xff), "header_len");
    EXPECT_EQ(fieldWith(2, 88), "payload_len") << "a longer header leaves less payload";
    for (std::uint8_t wrong : {0, 4, 255}) EXPECT_EQ(fieldWith(12, wrong), "target");
    for (std::uint8_t wrong : {0, 5, 255}) EXPECT_EQ(fieldWith(13, wrong), "encoding");
    for (std::uint8_t wrong : {0, 4, 255}) EXPECT_EQ(fieldWith(14, wrong), "sample");
    for (std::uint8_t wrong : {3, 255}) EXPECT_EQ(fieldWith(15, wrong), "layout");
}

TEST(FrameHeader, FieldsThatContradictEachOtherAreNamed) {
    const auto fieldOf = [](const std::function<void(FrameHeader&)>& change) {
        FrameHeader header = sampleFrame();
        change(header);
        Bytes bytes = message(sampleFrame());
        const auto start = encodeHeader(header);
        std::copy(start.begin(), start.end(), bytes.begin());
        const auto decoded = decodeFrameHeader(bytes);
        return decoded ? std::string("accepted") : decoded.error().field;
    };
    EXPECT_EQ(fieldOf([](FrameHeader&) {}), "accepted");
    EXPECT_EQ(fieldOf([](FrameHeader& h) { h.frameSeq = 0; }), "frame_seq");
    EXPECT_EQ(fieldOf([](FrameHeader& h) { h.payloadLen = 47; }), "payload_len");
    EXPECT_EQ(fieldOf([](FrameHeader& h) { h.payloadLen = 0xffffffff; }), "payload_len");
    EXPECT_EQ(fieldOf([](FrameHeader& h) { h.rawLen = 47; }), "raw_len");
    EXPECT_EQ(fieldOf([](FrameHeader& h) { h.width = 0; }), "width");
    EXPECT_EQ(fieldOf([](FrameHeader& h) { h.width = 65535; }), "width");
    EXPECT_EQ(fieldOf([](FrameHeader& h) { h.height = 4097; }), "width");
    EXPECT_EQ(fieldOf([](FrameHeader& h) { h.width = h.height = 4096; }), "width") << "more pixels than may be";
    EXPECT_EQ(fieldOf([](FrameHeader& h) { h.viewHeight = 0; }), "view_width");
    EXPECT_EQ(fieldOf([](FrameHeader& h) { h.bands = 0; }), "bands");
    EXPECT_EQ(fieldOf([](FrameHeader& h) { h.bands = 65; }), "bands");
    EXPECT_EQ(fieldOf([](FrameHeader& h) { h.jpegQuality = 101; }), "jpeg_quality");
    for (float wrong : {0.0f, -1.0f, std::numeric_limits<float>::infinity(), std::nanf("")})
        EXPECT_EQ(fieldOf([=](FrameHeader& h) { h.scale = wrong; }), "scale") << wrong;
    EXPECT_EQ(fieldOf([](FrameHeader& h) { h.sample = Sample::U8; }), "raw_len");
    EXPECT_EQ(fieldOf([](FrameHeader& h) { h.sample = Sample::U8, h.rawLen = 24; }), "payload_len")
        << "raw is as long as its samples";
    EXPECT_EQ(fieldOf([](FrameHeader& h) { h.sample = Sample::U8, h.rawLen = 24, h.encoding = Encoding::Jpeg; }),
              "accepted");
    EXPECT_EQ(fieldOf([](FrameHeader& h) { h.flags = 0xffffffff; }), "accepted") << "unknown flags are ignored";
}

TEST(FrameHeader, ThePayloadLimitHolds) {
    EXPECT_TRUE(decodeFrameHeader(message(sampleFrame()), {.framePayloadBytes = 48}).has_value());
    EXPECT_EQ(decodeFrameHeader(message(sampleFrame()), {.framePayloadBytes = 47}).error().code, ErrorCode::TooLarge);
}

TEST(ChunkHeader, LengthsAndOffsetsAreBounded) {
    const auto codeOf = [](const ChunkHeader& header) {
        const auto decoded = decodeChunkHeader(message(header));
        return decoded ? std::string_view("accepted") : errorName(decoded.error().code);
    };
    const Limits limits;
    ChunkHeader chunk = sampleChunk();
    chunk.payloadLen = std::uint32_t(limits.chunkBytes);
    EXPECT_EQ(codeOf(chunk), "accepted");
    ++chunk.payloadLen;
    EXPECT_EQ(codeOf(chunk), "too_large");
    chunk.payloadLen = 0;
    EXPECT_EQ(codeOf(chunk), "out_of_range");
    chunk.payloadLen = 16;
    chunk.offset = limits.assetBytes - 16;
    EXPECT_EQ(codeOf(chunk), "accepted");
    ++chunk.offset;
    EXPECT_EQ(codeOf(chunk), "bad_offset");
    chunk.offset = std::numeric_limits<std::uint64_t>::max() - 8;  // offset + length wraps
    EXPECT_EQ(codeOf(chunk), "bad_offset");
}

}  // namespace
}  // namespace caustream::protocol
