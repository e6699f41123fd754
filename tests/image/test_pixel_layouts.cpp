// The ways from a drawn picture to a JPEG: the same picture by each.
#include <turbojpeg.h>

#include "scene/builtin_scenes.h"
#include "stream/encoder.h"
#include "tests/image/image_fixture.h"

namespace caustream::image {
namespace {

using render::PixelLayout;

class PixelLayouts : public ImageTest {
   protected:
    static render::Request gem(int width, int height) {
        auto scene = scene::loadBuiltin("gem");
        EXPECT_TRUE(scene);
        render::Request request = pictureRequest(*scene, render::Sample::U8);
        request.width = width, request.height = height;
        return request;
    }
    static render::Frame as(PixelLayout pixels, render::Request request) {
        request.pixels = pixels;
        return pipeline().run(request);
    }
    static std::vector<std::uint8_t> jpegOf(const render::Frame& frame, stream::Subsampling subsampling) {
        stream::WireBuffer buffer = stream::Encoder().encode(frame, {.jpegQuality = 80, .subsampling = subsampling});
        const auto payload = buffer.bytes().subspan(protocol::kFrameHeaderBytes);
        return {payload.begin(), payload.end()};
    }
    static std::vector<std::uint8_t> decoded(const std::vector<std::uint8_t>& jpeg, const render::Frame& frame) {
        std::vector<std::uint8_t> rgb(3 * static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
        const tjhandle decoder = tjInitDecompress();
        EXPECT_EQ(tjDecompress2(decoder, jpeg.data(), jpeg.size(), rgb.data(), frame.width, 0, frame.height, TJPF_RGB, 0), 0);
        tjDestroy(decoder);
        return rgb;
    }
    static double squaredError(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
        return sum;
    }
};

TEST_F(PixelLayouts, FourBytesAreTheThreeAndOne) {
    const render::Request request = gem(95, 61);
    const render::Frame three = as(PixelLayout::Rgb, request), four = as(PixelLayout::Rgbx, request);
    std::vector<std::uint8_t> rgb;
    for (std::size_t i = 0; i < four.pixels.size(); i += 4) rgb.insert(rgb.end(), &four.pixels[i], &four.pixels[i] + 3);
    EXPECT_EQ(rgb, three.pixels);
    EXPECT_EQ(four.layout, PixelLayout::Rgbx);
}

TEST_F(PixelLayouts, EachGivesTheSameJpeg) {
    render::Request request = gem(160, 96);
    for (const bool still : {false, true}) {
        request.still = still;
        const render::Frame rgb = as(PixelLayout::Rgb, request);
        for (const auto subsampling : {stream::Subsampling::None, stream::Subsampling::Half}) {
            const bool half = subsampling == stream::Subsampling::Half;
            const auto jpeg = jpegOf(rgb, subsampling);
            EXPECT_EQ(jpegOf(as(PixelLayout::Rgbx, request), subsampling), jpeg);
            EXPECT_EQ(jpegOf(as(half ? PixelLayout::Yuv420 : PixelLayout::Yuv444, request), subsampling), jpeg) << half << still;
        }
    }
}

// Where blocks reach beyond the edge, each way continues the picture as it likes.
TEST_F(PixelLayouts, AnOddPictureIsAsNearToWhatWasDrawn) {
    const render::Request request = gem(157, 91);
    const render::Frame rgb = as(PixelLayout::Rgb, request);
    for (const auto subsampling : {stream::Subsampling::None, stream::Subsampling::Half}) {
        const auto planes = as(subsampling == stream::Subsampling::Half ? PixelLayout::Yuv420 : PixelLayout::Yuv444, request);
        const double far = squaredError(decoded(jpegOf(planes, subsampling), rgb), rgb.pixels);
        EXPECT_LT(far, 1.01 * squaredError(decoded(jpegOf(rgb, subsampling), rgb), rgb.pixels));   // .04 dB
    }
}

TEST_F(PixelLayouts, NumbersStayRgb) {
    render::Request request = gem(32, 32);
    request.sample = render::Sample::F32;
    EXPECT_EQ(as(PixelLayout::Yuv420, request).layout, PixelLayout::Rgb);
    EXPECT_EQ(as(PixelLayout::Yuv420, request).pixels.size(), 3u * 32 * 32 * sizeof(float));
    EXPECT_EQ(as(PixelLayout::Rgbx, request).layout, PixelLayout::Rgb);
}

// What the plan says of it reaches every client.
TEST_F(PixelLayouts, ThePlanSaysWhichIsReadBack) {
    const auto runs = [](const render::Frame& frame) {
        for (const render::PlanEntry& entry : frame.stats.plan) {
            if (entry.pass == "planar_yuv") return entry.run;
        }
        ADD_FAILURE() << "no row";
        return false;
    };
    EXPECT_TRUE(runs(as(PixelLayout::Yuv444, gem(32, 32))));
    EXPECT_FALSE(runs(as(PixelLayout::Rgb, gem(32, 32))));
    EXPECT_FALSE(runs(as(PixelLayout::Rgbx, gem(32, 32))));
}

}  // namespace
}  // namespace caustream::image
