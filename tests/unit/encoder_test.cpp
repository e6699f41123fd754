// Encoders: what a viewer decodes is what was rendered, whichever way the pixels came.
#include "stream/encoder.h"

#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <algorithm>
#include <cmath>

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

TEST(Encoder, OnlyJpegIsMadeOfOtherLayouts) {
    Encoder encoder;
    const Frame rgb = picture(32, 32);
    for (const auto encoding : {Encoding::Png, Encoding::Raw}) {
        EXPECT_NO_THROW(encoder.encode(rgb, {.encoding = encoding}));
        EXPECT_THROW(encoder.encode(withFourBytes(rgb), {.encoding = encoding}), Error);
        EXPECT_THROW(encoder.encode(planar(rgb, PixelLayout::Yuv444), {.encoding = encoding}), Error);
    }
}

}  // namespace
}  // namespace caustream::stream
