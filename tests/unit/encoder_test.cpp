// Encoders: what a viewer decodes is what was rendered, whichever way the pixels came.
#include "stream/encoder.h"

#include <gtest/gtest.h>
#include <turbojpeg.h>
#include <zstd.h>

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "client/connection/decoder.h"
#include "error.h"

namespace caustream::stream {
namespace {

using protocol::Encoding;
using render::Frame;
using render::PixelLayout;

// Dark, with bright thin lines of every hue: what a dispersed caustic is to a codec.
Frame picture(int width, int height) {
    Frame frame;
    frame.width = width, frame.height = height;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (int c = 0; c < 3; ++c) {
                const double wave = std::sin(0.11 * x + 0.07 * y + 2.1 * c) * std::cos(0.05 * x - 0.13 * y);
                frame.pixels.push_back(static_cast<std::uint8_t>(std::lround(40.0 + 200.0 * std::pow(std::abs(wave), 8.0))));
            }
        }
    }
    return frame;
}

Frame withFourBytes(const Frame& rgb) {
    Frame frame = rgb;
    frame.layout = PixelLayout::Rgbx;
    frame.pixels.clear();
    for (std::size_t i = 0; i < rgb.pixels.size(); i += 3) {
        frame.pixels.insert(frame.pixels.end(), {rgb.pixels[i], rgb.pixels[i + 1], rgb.pixels[i + 2], 77});
    }
    return frame;
}

Frame planar(const Frame& rgb, PixelLayout layout) {
    Frame frame = rgb;
    frame.layout = layout;
    const render::Planes all = render::planesOf(layout, rgb.width, rgb.height);
    frame.pixels.resize(all.bytes);
    std::array<unsigned char*, 3> planes{};
    std::array<int, 3> strides{};
    for (std::size_t i = 0; i < 3; ++i) planes[i] = frame.pixels.data() + all.planes[i].offset, strides[i] = all.planes[i].stride;
    const tjhandle jpeg = tjInitCompress();
    EXPECT_EQ(tjEncodeYUVPlanes(jpeg, rgb.pixels.data(), rgb.width, 0, rgb.height, TJPF_RGB, planes.data(), strides.data(),
                                layout == PixelLayout::Yuv420 ? TJSAMP_420 : TJSAMP_444, 0), 0);
    tjDestroy(jpeg);
    return frame;
}

std::vector<std::uint8_t> payload(WireBuffer buffer) {
    const auto bytes = buffer.bytes().subspan(protocol::kFrameHeaderBytes);
    return {bytes.begin(), bytes.end()};
}

struct Decoded {
    int width = 0, height = 0, sampling = -1;
    std::vector<std::uint8_t> rgb;
};

Decoded decode(const std::vector<std::uint8_t>& jpeg) {
    Decoded out;
    int colours = 0;
    const tjhandle decoder = tjInitDecompress();
    EXPECT_EQ(tjDecompressHeader3(decoder, jpeg.data(), jpeg.size(), &out.width, &out.height, &out.sampling, &colours), 0);
    out.rgb.resize(3 * static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    EXPECT_EQ(tjDecompress2(decoder, jpeg.data(), jpeg.size(), out.rgb.data(), out.width, 0, out.height, TJPF_RGB, TJFLAG_ACCURATEDCT), 0);
    tjDestroy(decoder);
    return out;
}

double psnr(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum == 0.0 ? 99.0 : 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(a.size()) / sum);
}

EncodeSettings jpegOf(int quality, Subsampling subsampling = Subsampling::None) { return {Encoding::Jpeg, quality, subsampling}; }

TEST(Encoder, PlanesAndRgbGiveTheSameJpeg) {
    Encoder encoder;
    const Frame rgb = picture(160, 96);   // whole blocks: beyond the edge each way continues the picture as it likes
    for (const bool half : {false, true}) {
        const auto settings = jpegOf(80, half ? Subsampling::Half : Subsampling::None);
        const auto planes = planar(rgb, half ? PixelLayout::Yuv420 : PixelLayout::Yuv444);
        EXPECT_EQ(payload(encoder.encode(planes, settings)), payload(encoder.encode(rgb, settings))) << half;
    }
    EXPECT_EQ(payload(encoder.encode(withFourBytes(rgb), jpegOf(90))), payload(encoder.encode(rgb, jpegOf(90))));
}

TEST(Encoder, AnOddPictureIsAsGoodByEitherWay) {
    Encoder encoder;
    const Frame rgb = picture(157, 91);
    for (const bool half : {false, true}) {
        const auto settings = jpegOf(80, half ? Subsampling::Half : Subsampling::None);
        const Decoded from = decode(payload(encoder.encode(rgb, settings)));
        const Decoded planes = decode(payload(encoder.encode(planar(rgb, half ? PixelLayout::Yuv420 : PixelLayout::Yuv444), settings)));
        ASSERT_EQ(planes.rgb.size(), rgb.pixels.size());
        EXPECT_GT(psnr(planes.rgb, rgb.pixels), psnr(from.rgb, rgb.pixels) - 0.05) << half;
    }
}

TEST(Encoder, JpegsHaveTheSubsamplingAndTheQualityAskedFor) {
    Encoder encoder;
    const Frame rgb = picture(128, 128);
    const auto full = payload(encoder.encode(rgb, jpegOf(80))), half = payload(encoder.encode(rgb, jpegOf(80, Subsampling::Half)));
    EXPECT_EQ(decode(full).sampling, TJSAMP_444);
    EXPECT_EQ(decode(half).sampling, TJSAMP_420);
    EXPECT_LT(half.size(), full.size());
    EXPECT_LT(payload(encoder.encode(rgb, jpegOf(60))).size(), full.size());
    EXPECT_GT(psnr(decode(full).rgb, rgb.pixels), 33.0);   // what quality 80 is worth
}

// Samples that differ in every byte, so that none may take another's place.
Frame mapOf(render::Sample sample, int bands) {
    Frame frame;
    frame.width = 19, frame.height = 7, frame.bands = bands, frame.sample = sample;
    const std::size_t bytes = sample == render::Sample::U8 ? 1 : sample == render::Sample::F16 ? 2 : 4;
    frame.pixels.resize(19 * 7 * static_cast<std::size_t>(bands) * bytes);
    for (std::size_t i = 0; i < frame.pixels.size(); ++i) frame.pixels[i] = static_cast<std::uint8_t>(i * 37 + i / 256);
    return frame;
}

protocol::FrameHeader headerOf(const Frame& frame, Encoding encoding) {
    protocol::FrameHeader header;
    header.encoding = encoding;
    header.sample = frame.sample == render::Sample::U8    ? protocol::Sample::U8
                    : frame.sample == render::Sample::F16 ? protocol::Sample::F16
                                                          : protocol::Sample::F32;
    header.layout = layoutOf(encoding, header.sample);
    header.width = static_cast<std::uint16_t>(frame.width), header.height = static_cast<std::uint16_t>(frame.height);
    header.bands = static_cast<std::uint16_t>(frame.bands);
    return header;
}

TEST(Encoder, ZstdComesBackBitForBit) {
    Encoder encoder;
    for (const auto sample : {render::Sample::U8, render::Sample::F16, render::Sample::F32}) {
        for (const int bands : {1, 3, 7}) {
            const Frame frame = mapOf(sample, bands);
            const auto bytes = payload(encoder.encode(frame, {.encoding = Encoding::Zstd}));
            const auto image = connection::Decoder().decode(headerOf(frame, Encoding::Zstd), bytes);
            ASSERT_TRUE(image.has_value()) << image.error();
            EXPECT_EQ(image->data, frame.pixels) << bands;
            EXPECT_EQ(image->bands, bands);
        }
    }
}

TEST(Encoder, ShufflingIsAsTheProtocolSays) {
    Frame frame;
    frame.width = 2, frame.height = 1, frame.bands = 2, frame.sample = render::Sample::F16;
    frame.pixels = {0x11, 0x12, 0x21, 0x22, 0x31, 0x32, 0x41, 0x42};   // texel 0 band 0, texel 0 band 1, texel 1 band 0...
    const auto bytes = payload(Encoder().encode(frame, {.encoding = Encoding::Zstd}));
    std::vector<std::uint8_t> shuffled(8);
    ASSERT_EQ(ZSTD_decompress(shuffled.data(), shuffled.size(), bytes.data(), bytes.size()), 8u);
    EXPECT_EQ(shuffled, (std::vector<std::uint8_t>{0x11, 0x31, 0x21, 0x41, 0x12, 0x32, 0x22, 0x42}));
}

TEST(Encoder, SmoothMapsShrinkMoreForBeingShuffled) {
    Frame frame;
    frame.width = frame.height = 128, frame.bands = 3, frame.sample = render::Sample::F32;
    for (int i = 0; i < 128 * 128 * 3; ++i) {
        const float value = 1.0f + 0.5f * std::sin(0.01f * static_cast<float>(i));
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
        frame.pixels.insert(frame.pixels.end(), bytes, bytes + sizeof value);
    }
    std::vector<std::uint8_t> plain(ZSTD_compressBound(frame.pixels.size()));
    const std::size_t unshuffled = ZSTD_compress(plain.data(), plain.size(), frame.pixels.data(), frame.pixels.size(), 1);
    EXPECT_LT(static_cast<double>(payload(Encoder().encode(frame, {.encoding = Encoding::Zstd})).size()), 0.9 * static_cast<double>(unshuffled));
}

TEST(Decoder, RefusesZstdThatIsNotWhatItsHeaderSays) {
    const Frame frame = mapOf(render::Sample::F16, 3);
    const auto good = payload(Encoder().encode(frame, {.encoding = Encoding::Zstd}));
    const protocol::FrameHeader header = headerOf(frame, Encoding::Zstd);
    connection::Decoder decoder;
    ASSERT_TRUE(decoder.decode(header, good).has_value());
    for (std::size_t cut = 0; cut < good.size(); cut += 1 + good.size() / 50) {
        EXPECT_FALSE(decoder.decode(header, std::span(good).first(cut)).has_value()) << cut;
    }
    protocol::FrameHeader other = header;
    other.width = 18;   // fewer samples than there are
    EXPECT_FALSE(decoder.decode(other, good).has_value());
    other.width = other.height = 4096, other.bands = 64;   // and more than anyone should take memory for
    EXPECT_FALSE(decoder.decode(other, good).has_value());
    auto twice = good;
    twice.insert(twice.end(), good.begin(), good.end());
    EXPECT_FALSE(decoder.decode(header, twice).has_value());
    EXPECT_FALSE(decoder.decode(header, std::vector<std::uint8_t>(64, 0xaa)).has_value());
}

TEST(Encoder, OnlyJpegIsMadeOfOtherLayouts) {
    Encoder encoder;
    const Frame rgb = picture(32, 32);
    for (const auto encoding : {Encoding::Png, Encoding::Raw, Encoding::Zstd}) {
        EXPECT_NO_THROW(encoder.encode(rgb, {.encoding = encoding}));
        EXPECT_THROW(encoder.encode(withFourBytes(rgb), {.encoding = encoding}), Error);
        EXPECT_THROW(encoder.encode(planar(rgb, PixelLayout::Yuv444), {.encoding = encoding}), Error);
    }
}

}  // namespace
}  // namespace caustream::stream
