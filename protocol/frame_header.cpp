#include "protocol/frame_header.h"

#include <bit>
#include <cmath>
#include <string>

namespace caustream::protocol {
namespace {

// Fields are written and read in the order of the table in README.md, each at the place the one before ended.
class Writer {
 public:
    explicit Writer(std::uint8_t* to) : to_(to) {}
    template <class T>
    Writer& put(T value) {
        for (std::size_t i = 0; i < sizeof(T); ++i) *to_++ = static_cast<std::uint8_t>(std::uint64_t(value) >> (8 * i));
        return *this;
    }

 private:
    std::uint8_t* to_;
};

class Reader {  // the caller has checked that the bytes are there
 public:
    explicit Reader(const std::uint8_t* from) : from_(from) {}
    template <class T>
    T get() {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i) value |= std::uint64_t(*from_++) << (8 * i);
        return static_cast<T>(value);
    }
    template <class T>
    void get(T& value) {
        value = get<T>();
    }

 private:
    const std::uint8_t* from_;
};

tl::unexpected<DecodeError> fail(ErrorCode code, const char* field, std::string message) {
    return tl::unexpected(DecodeError{code, std::move(message), field, std::nullopt});
}

// The four bytes both headers start with.
tl::expected<std::uint16_t, DecodeError> checkStart(std::span<const std::uint8_t> message, std::uint8_t op,
                                                    std::size_t minBytes) {
    if (message.size() < minBytes)
        return fail(ErrorCode::BadMessage, "header_len",
                    "the message has " + std::to_string(message.size()) + " bytes, its header alone has " +
                        std::to_string(minBytes));
    Reader in(message.data());
    if (in.get<std::uint8_t>() != op) return fail(ErrorCode::BadMessage, "op", "must be " + std::to_string(op));
    if (in.get<std::uint8_t>() != kHeaderVersion) return fail(ErrorCode::BadMessage, "header_version", "must be 1");
    const auto headerLen = in.get<std::uint16_t>();
    if (headerLen < minBytes || headerLen % 8 != 0 || headerLen > message.size())
        return fail(ErrorCode::BadMessage, "header_len",
                    "must be a multiple of 8, at least " + std::to_string(minBytes) + ", and within the message");
    return headerLen;
}

std::optional<DecodeError> checkPicture(const FrameHeader& header, const Limits& limits) {
    const auto bad = [](const char* field, std::string message) {
        return DecodeError{ErrorCode::OutOfRange, std::move(message), field, std::nullopt};
    };
    const auto fits = [&](std::uint32_t width, std::uint32_t height) {
        return width >= 1 && height >= 1 && width <= limits.frameMaxSide && height <= limits.frameMaxSide &&
               width * height <= limits.framePixels;
    };
    if (!fits(header.width, header.height)) return bad("width", "width and height must be within the limits");
    if (!fits(header.viewWidth, header.viewHeight))
        return bad("view_width", "view_width and view_height must be within the limits");
    if (header.bands < 1 || header.bands > limits.bands) return bad("bands", "must be within the limits");
    if (header.jpegQuality > 100) return bad("jpeg_quality", "must be 0 to 100");
    if (!std::isfinite(header.scale) || header.scale <= 0.0f) return bad("scale", "must be finite and above 0");
    // At most 8.3e6 * 64 * 4: far from overflowing 64 bits.
    const std::uint64_t rawBytes =
        std::uint64_t(header.width) * header.height * header.bands * sampleBytes(header.sample);
    if (header.rawLen != rawBytes) return bad("raw_len", "must be width * height * bands * bytes of a sample");
    if (header.encoding == Encoding::Raw && header.payloadLen != header.rawLen)
        return bad("payload_len", "must equal raw_len for a raw frame");
    return std::nullopt;
}

}  // namespace

std::size_t sampleBytes(Sample sample) {
    switch (sample) {
        case Sample::U8:
            return 1;
        case Sample::F16:
            return 2;
        case Sample::F32:
            return 4;
    }
    return 0;
}

std::array<std::uint8_t, kFrameHeaderBytes> encodeHeader(const FrameHeader& header) {
    std::array<std::uint8_t, kFrameHeaderBytes> bytes;
    // One line per row of the table in README.md.
    // clang-format off
    Writer(bytes.data())
        .put(kFrameOp).put(kHeaderVersion).put(std::uint16_t(kFrameHeaderBytes))
        .put(header.frameSeq)
        .put(header.stream).put(header.epoch)
        .put(std::uint8_t(header.target)).put(std::uint8_t(header.encoding))
        .put(std::uint8_t(header.sample)).put(std::uint8_t(header.layout))
        .put(header.flags)
        .put(header.width).put(header.height)
        .put(header.viewWidth).put(header.viewHeight)
        .put(header.bands).put(header.jpegQuality).put(header.level)
        .put(header.inputSeq).put(header.stateRev)
        .put(header.clientUs).put(header.serverUs)
        .put(header.holdUs).put(header.renderUs).put(header.encodeUs)
        .put(header.payloadLen).put(header.rawLen)
        .put(std::bit_cast<std::uint32_t>(header.scale));
    // clang-format on
    return bytes;
}

std::array<std::uint8_t, kChunkHeaderBytes> encodeHeader(const ChunkHeader& header) {
    std::array<std::uint8_t, kChunkHeaderBytes> bytes;
    Writer(bytes.data())
        .put(kChunkOp)
        .put(kHeaderVersion)
        .put(std::uint16_t(kChunkHeaderBytes))
        .put(header.asset)
        .put(header.offset)
        .put(header.payloadLen)
        .put(header.crc32);
    return bytes;
}

tl::expected<FrameHeader, DecodeError> decodeFrameHeader(std::span<const std::uint8_t> message, const Limits& limits) {
    const auto headerLen = checkStart(message, kFrameOp, kFrameHeaderBytes);
    if (!headerLen) return tl::unexpected(headerLen.error());
    Reader in(message.data() + 4);
    FrameHeader header;
    header.headerLen = *headerLen;
    in.get(header.frameSeq);
    in.get(header.stream);
    in.get(header.epoch);
    const auto target = in.get<std::uint8_t>(), encoding = in.get<std::uint8_t>(), sample = in.get<std::uint8_t>(),
               layout = in.get<std::uint8_t>();
    if (target < 1 || target > 3) return fail(ErrorCode::Unsupported, "target", "must be 1 to 3");
    if (encoding < 1 || encoding > 4) return fail(ErrorCode::Unsupported, "encoding", "must be 1 to 4");
    if (sample < 1 || sample > 3) return fail(ErrorCode::Unsupported, "sample", "must be 1 to 3");
    if (layout > 2) return fail(ErrorCode::Unsupported, "layout", "must be 0 to 2");
    header.target = Target{target};
    header.encoding = Encoding{encoding};
    header.sample = Sample{sample};
    header.layout = Layout{layout};
    in.get(header.flags);
    in.get(header.width);
    in.get(header.height);
    in.get(header.viewWidth);
    in.get(header.viewHeight);
    in.get(header.bands);
    in.get(header.jpegQuality);
    in.get(header.level);
    in.get(header.inputSeq);
    in.get(header.stateRev);
    in.get(header.clientUs);
    in.get(header.serverUs);
    in.get(header.holdUs);
    in.get(header.renderUs);
    in.get(header.encodeUs);
    in.get(header.payloadLen);
    in.get(header.rawLen);
    header.scale = std::bit_cast<float>(in.get<std::uint32_t>());
    if (header.frameSeq == 0) return fail(ErrorCode::OutOfRange, "frame_seq", "starts at 1");
    if (header.payloadLen != message.size() - header.headerLen)
        return fail(ErrorCode::BadMessage, "payload_len", "must be what follows the header");
    if (header.payloadLen > limits.framePayloadBytes)
        return fail(ErrorCode::TooLarge, "payload_len", "must be within the limits");
    if (auto error = checkPicture(header, limits)) return tl::unexpected(*std::move(error));
    return header;
}

tl::expected<ChunkHeader, DecodeError> decodeChunkHeader(std::span<const std::uint8_t> message, const Limits& limits) {
    const auto headerLen = checkStart(message, kChunkOp, kChunkHeaderBytes);
    if (!headerLen) return tl::unexpected(headerLen.error());
    Reader in(message.data() + 4);
    ChunkHeader header;
    header.headerLen = *headerLen;
    in.get(header.asset);
    in.get(header.offset);
    in.get(header.payloadLen);
    in.get(header.crc32);
    if (header.payloadLen != message.size() - header.headerLen)
        return fail(ErrorCode::BadMessage, "payload_len", "must be what follows the header");
    if (header.payloadLen == 0) return fail(ErrorCode::OutOfRange, "payload_len", "a chunk holds at least one byte");
    if (header.payloadLen > limits.chunkBytes)
        return fail(ErrorCode::TooLarge, "payload_len", "must be 1 to " + std::to_string(limits.chunkBytes));
    // Subtraction, as the sum may wrap.
    if (header.offset > limits.assetBytes || header.payloadLen > limits.assetBytes - header.offset)
        return fail(ErrorCode::BadOffset, "offset", "reaches past the largest asset there may be");
    return header;
}

}  // namespace caustream::protocol
