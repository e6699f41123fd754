#include "client/connection/decoder.h"

#include <png.h>
#include <turbojpeg.h>
#include <zstd.h>

#include <cstring>

namespace caustream::connection {
namespace {

using protocol::Encoding;
using protocol::FrameHeader;
using protocol::Layout;
using protocol::Sample;
using Result = tl::expected<Image, std::string>;

tl::unexpected<std::string> refused(const std::string& why) {
    return tl::make_unexpected("frame refused: " + why);
}

Image emptyImage(const FrameHeader& header) {
    return {header.width, header.height, header.bands, header.sample, header.scale, {}};
}

Result decodeJpeg(tjhandle decoder, const FrameHeader& header, std::span<const std::uint8_t> payload) {
    int width = 0, height = 0, subsampling = 0, space = 0;
    const auto size = static_cast<unsigned long>(payload.size());
    if (tjDecompressHeader3(decoder, payload.data(), size, &width, &height, &subsampling, &space) != 0)
        return refused(tjGetErrorStr2(decoder));
    if (width != header.width || height != header.height || header.bands != 3 || header.sample != Sample::U8)
        return refused("the JPEG's size is not the header's");
    Image image = emptyImage(header);
    image.data.resize(image.samples());
    // A warning (a truncated last block, say) still gives a picture; only errors do not.
    if (tjDecompress2(decoder, payload.data(), size, image.data.data(), width, 0, height, TJPF_RGB, TJFLAG_FASTDCT) !=
            0 &&
        tjGetErrorCode(decoder) == TJERR_FATAL)
        return refused(tjGetErrorStr2(decoder));
    return image;
}

Result decodePng(const FrameHeader& header, std::span<const std::uint8_t> payload) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_memory(&png, payload.data(), payload.size())) return refused(png.message);
    const bool fits = png.width == header.width && png.height == header.height && header.sample == Sample::U8 &&
                      (header.bands == 3 || header.bands == 1);
    if (!fits) {
        png_image_free(&png);
        return refused("the PNG's size is not the header's");
    }
    png.format = header.bands == 3 ? PNG_FORMAT_RGB : PNG_FORMAT_GRAY;
    Image image = emptyImage(header);
    image.data.resize(image.samples());
    if (!png_image_finish_read(&png, nullptr, image.data.data(), 0, nullptr)) return refused(png.message);
    return image;
}

// The first bytes of all samples, band after band, then the second bytes, and so on.
Image unshuffled(Image image, std::span<const std::uint8_t> payload, std::size_t size) {
    image.data.resize(payload.size());
    const std::size_t bands = image.bands, samples = image.samples(), texels = samples / bands;
    for (std::size_t byte = 0; byte < size; ++byte)
        for (std::size_t band = 0; band < bands; ++band)
            for (std::size_t i = 0; i < texels; ++i)
                image.data[(i * bands + band) * size + byte] = payload[byte * samples + band * texels + i];
    return image;
}

Result decodeRaw(const FrameHeader& header, std::span<const std::uint8_t> payload) {
    Image image = emptyImage(header);
    const std::size_t size = protocol::sampleBytes(header.sample), bands = header.bands;
    if (payload.size() != image.samples() * size) return refused("the payload is not width x height x bands samples");
    if (header.layout == Layout::PlanarShuffle) return unshuffled(std::move(image), payload, size);
    if (header.layout == Layout::Interleaved || bands == 1) {
        image.data.assign(payload.begin(), payload.end());
        return image;
    }
    image.data.resize(payload.size());
    const std::size_t texels = image.samples() / bands;
    for (std::size_t band = 0; band < bands; ++band)
        for (std::size_t i = 0; i < texels; ++i)
            std::memcpy(&image.data[(i * bands + band) * size], &payload[(band * texels + i) * size], size);
    return image;
}

Result decodeZstd(const FrameHeader& header, std::span<const std::uint8_t> payload) {
    const std::size_t bytes = emptyImage(header).samples() * protocol::sampleBytes(header.sample);
    if (bytes > protocol::Limits{}.framePayloadBytes) return refused("its samples are more than a frame may have");
    if (ZSTD_getFrameContentSize(payload.data(), payload.size()) != bytes)
        return refused("the zstd frame is not of width x height x bands samples");
    std::vector<std::uint8_t> samples(bytes);
    const std::size_t got = ZSTD_decompress(samples.data(), samples.size(), payload.data(), payload.size());
    if (ZSTD_isError(got)) return refused(ZSTD_getErrorName(got));
    if (got != bytes) return refused("the zstd frame is not of width x height x bands samples");
    return decodeRaw(header, samples);
}

}  // namespace

Decoder::Decoder() : jpeg_(tjInitDecompress(), [](void* handle) { return handle ? tjDestroy(handle) : 0; }) {}

Result Decoder::decode(const FrameHeader& header, std::span<const std::uint8_t> payload) {
    if (header.width == 0 || header.height == 0 || header.bands == 0) return refused("it has no samples");
    switch (header.encoding) {
        case Encoding::Jpeg:
            return jpeg_ ? decodeJpeg(jpeg_.get(), header, payload) : refused("no JPEG decoder");
        case Encoding::Png:
            return decodePng(header, payload);
        case Encoding::Raw:
            return decodeRaw(header, payload);
        case Encoding::Zstd:
            return decodeZstd(header, payload);
    }
    return refused("its encoding was not asked for");
}

}  // namespace caustream::connection
