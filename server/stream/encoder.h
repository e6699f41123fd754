// A rendered frame -> the payload of a wire message, behind free room for its header. Any thread; one Encoder per thread.
#pragma once
#include <memory>

#include "protocol/frame_header.h"
#include "render/frame.h"
#include "stream/ladder.h"
#include "stream/wire_buffer.h"

namespace caustream::stream {

struct EncodeSettings {
    protocol::Encoding encoding = protocol::Encoding::Jpeg;  // Zstd is refused
    int jpegQuality = 90;  // 1..100
    Subsampling subsampling = Subsampling::None;  // of a JPEG of RGB; planes have theirs already
};

class Encoder {
   public:
    Encoder();
    ~Encoder();

    // Bytes [0, protocol::kFrameHeaderBytes) are free for the header, the payload follows. Throws Error when the codec refuses.
    // JPEG and PNG need 8-bit RGB, JPEG alone reads planes too; Raw sends any samples as they are, little-endian.
    WireBuffer encode(const render::Frame& frame, const EncodeSettings& settings);

   private:
    WireBuffer jpeg(const render::Frame& frame, const EncodeSettings& settings);
    static WireBuffer png(const render::Frame& frame);
    static WireBuffer raw(const render::Frame& frame);

    struct Free {
        void operator()(void* handle) const;
    };
    std::unique_ptr<void, Free> compressor_;
};

}  // namespace caustream::stream
