// A rendered frame -> the payload of a wire message, behind free room for its header. Any thread; one Encoder per thread.
#pragma once
#include <memory>

#include "protocol/frame_header.h"
#include "render/frame.h"
#include "stream/ladder.h"
#include "stream/wire_buffer.h"

struct ZSTD_CCtx_s;

namespace caustream::stream {

struct EncodeSettings {
    protocol::Encoding encoding = protocol::Encoding::Jpeg;
    int jpegQuality = 90;  // 1..100
    Subsampling subsampling = Subsampling::None;  // of a JPEG of RGB; planes have theirs already
};

// How an encoding has its samples: those of more than a byte are shuffled for zstd, everything else is interleaved.
protocol::Layout layoutOf(protocol::Encoding encoding, protocol::Sample sample);

class Encoder {
   public:
    Encoder();
    ~Encoder();

    // Bytes [0, protocol::kFrameHeaderBytes) are free for the header, the payload follows. Throws Error when the codec refuses.
    // JPEG and PNG need 8-bit RGB, JPEG alone reads planes too; Raw sends any samples as they are, little-endian, and Zstd
    // the same without loss, as layoutOf() says.
    WireBuffer encode(const render::Frame& frame, const EncodeSettings& settings);

   private:
    WireBuffer jpeg(const render::Frame& frame, const EncodeSettings& settings);
    static WireBuffer png(const render::Frame& frame);
    static WireBuffer raw(const render::Frame& frame);
    WireBuffer zstd(const render::Frame& frame);

    struct Free {
        void operator()(void* handle) const;
    };
    struct FreeZstd {
        void operator()(ZSTD_CCtx_s* context) const;
    };
    std::unique_ptr<void, Free> compressor_;
    std::unique_ptr<ZSTD_CCtx_s, FreeZstd> zstd_;   // made when first used
};

}  // namespace caustream::stream
