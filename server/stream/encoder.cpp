#include "stream/encoder.h"

#include <png.h>
#include <turbojpeg.h>
#include <zstd.h>

#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "error.h"

static_assert(std::endian::native == std::endian::little, "raw frames are sent as they lie in memory");

namespace caustream::stream {

using protocol::Encoding;
using protocol::kFrameHeaderBytes;
using render::PixelLayout;

namespace {

constexpr int kZstdLevel = 1;   // its fastest: noise compresses no better for more time

// Interleaved samples -> the first bytes of all of them, band after band, then the second bytes, and so on: what samples
// have in common, sign and exponent, comes together.
std::vector<std::uint8_t> shuffle(const render::Frame& frame) {
    const std::size_t bands = static_cast<std::size_t>(frame.bands), bytes = frame.sample == render::Sample::F16 ? 2 : 4;
    const std::size_t samples = frame.pixels.size() / bytes, texels = samples / bands;
    std::vector<std::uint8_t> out(frame.pixels.size());
    for (std::size_t byte = 0; byte < bytes; ++byte) {
        for (std::size_t band = 0; band < bands; ++band) {
            std::uint8_t* to = &out[byte * samples + band * texels];
            for (std::size_t i = 0; i < texels; ++i) to[i] = frame.pixels[(i * bands + band) * bytes + byte];
        }
    }
    return out;
}

}  // namespace

protocol::Layout layoutOf(Encoding encoding, protocol::Sample sample) {
    return encoding == Encoding::Zstd && sample != protocol::Sample::U8 ? protocol::Layout::PlanarShuffle : protocol::Layout::Interleaved;
}

void Encoder::Free::operator()(void* handle) const { tjDestroy(handle); }
void Encoder::FreeZstd::operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }

Encoder::Encoder() : compressor_(tjInitCompress()) {
    if (!compressor_) {
        throw Error(std::string("JPEG encoder: ") + tjGetErrorStr2(nullptr) + "; check the memory limit");
    }
}

Encoder::~Encoder() = default;

WireBuffer Encoder::encode(const render::Frame& frame, const EncodeSettings& settings) {
    const bool picture = frame.sample == render::Sample::U8 && frame.bands == 3;
    if ((settings.encoding == Encoding::Jpeg || settings.encoding == Encoding::Png) && !picture) {
        throw Error("encoder: JPEG and PNG hold 8-bit RGB only; ask for encoding raw");
    }
    if (settings.encoding == Encoding::Jpeg) return jpeg(frame, settings);
    if (frame.layout != PixelLayout::Rgb) {
        throw Error("encoder: only JPEG is made of planes or of four bytes a pixel; ask the renderer for RGB");
    }
    switch (settings.encoding) {
        case Encoding::Png: return png(frame);
        case Encoding::Zstd: return zstd(frame);
        case Encoding::Raw:
        case Encoding::Jpeg: break;
    }
    return raw(frame);
}

WireBuffer Encoder::jpeg(const render::Frame& frame, const EncodeSettings& settings) {
    const int width = frame.width, height = frame.height;
    const bool planar = render::isPlanar(frame.layout);
    const bool half = planar ? frame.layout == PixelLayout::Yuv420 : settings.subsampling == Subsampling::Half;
    const int sampling = half ? TJSAMP_420 : TJSAMP_444;
    unsigned long size = tjBufSize(width, height, sampling);
    WireBuffer buffer(kFrameHeaderBytes + size);
    unsigned char* out = buffer.data() + kFrameHeaderBytes;
    int failed = 0;
    if (planar) {
        std::array<const unsigned char*, 3> planes{};
        std::array<int, 3> strides{};
        const render::Planes all = render::planesOf(frame.layout, width, height);
        for (std::size_t i = 0; i < planes.size(); ++i) {
            planes[i] = frame.pixels.data() + all.planes[i].offset;
            strides[i] = all.planes[i].stride;
        }
        failed = tjCompressFromYUVPlanes(compressor_.get(), planes.data(), width, strides.data(), height, sampling, &out,
                                         &size, settings.jpegQuality, TJFLAG_NOREALLOC);
    } else {
        const int format = frame.layout == PixelLayout::Rgbx ? TJPF_RGBX : TJPF_RGB;
        failed = tjCompress2(compressor_.get(), frame.pixels.data(), width, 0, height, format, &out, &size, sampling,
                             settings.jpegQuality, TJFLAG_NOREALLOC);
    }
    if (failed != 0) {
        throw Error(std::string("JPEG encoder: ") + tjGetErrorStr2(compressor_.get()) + "; try encoding raw");
    }
    buffer.shrink(kFrameHeaderBytes + size);
    return buffer;
}

WireBuffer Encoder::png(const render::Frame& frame) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(frame.width);
    image.height = static_cast<png_uint_32>(frame.height);
    image.format = PNG_FORMAT_RGB;
    image.flags = PNG_IMAGE_FLAG_FAST;  // a quarter of the time for about a tenth more bytes
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    WireBuffer buffer(kFrameHeaderBytes + size);
    if (!png_image_write_to_memory(&image, buffer.data() + kFrameHeaderBytes, &size, 0, frame.pixels.data(), 0, nullptr)) {
        throw Error(std::string("PNG encoder: ") + image.message + "; try encoding raw");
    }
    buffer.shrink(kFrameHeaderBytes + size);
    return buffer;
}

WireBuffer Encoder::raw(const render::Frame& frame) {
    WireBuffer buffer(kFrameHeaderBytes + frame.pixels.size());
    std::memcpy(buffer.data() + kFrameHeaderBytes, frame.pixels.data(), frame.pixels.size());
    return buffer;
}

WireBuffer Encoder::zstd(const render::Frame& frame) {
    if (!zstd_) {
        zstd_.reset(ZSTD_createCCtx());
        if (!zstd_) throw Error("zstd encoder: no memory; try encoding raw");
    }
    const std::vector<std::uint8_t> shuffled = frame.sample == render::Sample::U8 ? std::vector<std::uint8_t>{} : shuffle(frame);
    const std::vector<std::uint8_t>& samples = shuffled.empty() ? frame.pixels : shuffled;
    WireBuffer buffer(kFrameHeaderBytes + ZSTD_compressBound(samples.size()));
    const std::size_t size = ZSTD_compressCCtx(zstd_.get(), buffer.data() + kFrameHeaderBytes, buffer.size() - kFrameHeaderBytes,
                                               samples.data(), samples.size(), kZstdLevel);
    if (ZSTD_isError(size)) {
        throw Error(std::string("zstd encoder: ") + ZSTD_getErrorName(size) + "; try encoding raw");
    }
    buffer.shrink(kFrameHeaderBytes + size);
    return buffer;
}

}  // namespace caustream::stream
