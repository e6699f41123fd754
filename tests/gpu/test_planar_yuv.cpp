// planar_yuv: the planes are those that libjpeg makes of the same picture, byte for byte.
#include "render/passes/planar_yuv.h"

#include <turbojpeg.h>

#include <random>

#include "render/read_back.h"
#include "tests/gpu/camera_fixture.h"

namespace caustream::tests {
namespace {

using render::PixelLayout;

class PlanarYuvTest : public CameraPass {
   protected:
    static std::vector<std::uint8_t> noise(int width, int height) {
        std::mt19937 random(7);
        std::vector<std::uint8_t> rgba(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
        for (std::uint8_t& byte : rgba) byte = static_cast<std::uint8_t>(random());
        return rgba;
    }

    static gl::Texture imageOf(const std::vector<std::uint8_t>& rgba, int width, int height) {
        gl::Texture image(width, height, GL_RGBA8, "input");
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glTextureSubImage2D(image.get(), 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
        return image;
    }

    render::Frame planesOnGpu(const std::vector<std::uint8_t>& rgba, int width, int height, PixelLayout layout) {
        const gl::Texture image = imageOf(rgba, width, height);
        render::PlanarYuv(shaders_).run(image, layout, {planes_});
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        render::Frame frame;
        render::readPlanes(planes_, layout, width, height, frame);
        return frame;
    }

    // libjpeg's own conversion and averaging, one plane of tight rows after the other.
    static std::vector<std::uint8_t> planesOfLibjpeg(const std::vector<std::uint8_t>& rgba, int width, int height, PixelLayout layout) {
        const int sampling = layout == PixelLayout::Yuv420 ? TJSAMP_420 : TJSAMP_444;
        std::array<std::vector<std::uint8_t>, 3> planes;
        std::array<unsigned char*, 3> out{};
        for (int i = 0; i < 3; ++i) {
            planes[std::size_t(i)].resize(tjPlaneSizeYUV(i, width, 0, height, sampling));
            out[std::size_t(i)] = planes[std::size_t(i)].data();
        }
        const tjhandle jpeg = tjInitCompress();
        EXPECT_EQ(tjEncodeYUVPlanes(jpeg, rgba.data(), width, 0, height, TJPF_RGBX, out.data(), nullptr, sampling, 0), 0) << tjGetErrorStr2(jpeg);
        tjDestroy(jpeg);
        std::vector<std::uint8_t> all;
        for (const auto& plane : planes) all.insert(all.end(), plane.begin(), plane.end());
        return all;
    }

    static std::vector<std::uint8_t> tight(const render::Frame& frame) {
        std::vector<std::uint8_t> all;
        for (const auto& plane : render::planesOf(frame.layout, frame.width, frame.height).planes) {
            for (int y = 0; y < plane.height; ++y) {
                const auto row = frame.pixels.begin() + std::ptrdiff_t(plane.offset) + std::ptrdiff_t(y) * plane.stride;
                all.insert(all.end(), row, row + plane.width);
            }
        }
        return all;
    }

    gl::Buffer planes_;
};

TEST_F(PlanarYuvTest, PlanesAreLibjpegs) {
    const std::pair<int, int> kSizes[] = {{64, 64}, {96, 32}, {37, 21}, {16, 17}, {6, 2}, {5, 3}, {1, 1}};
    for (const PixelLayout layout : {PixelLayout::Yuv444, PixelLayout::Yuv420}) {
        for (const auto& [width, height] : kSizes) {
            const auto rgba = noise(width, height);
            EXPECT_EQ(tight(planesOnGpu(rgba, width, height, layout)), planesOfLibjpeg(rgba, width, height, layout))
                << width << " x " << height << (layout == PixelLayout::Yuv420 ? ", 4:2:0" : ", 4:4:4");
        }
    }
}

TEST_F(PlanarYuvTest, GreyHasNoColourAndPrimariesHaveTheStandards) {
    // ITU-T T.871, 7: Y 0..255, Cb and Cr around 128; of red, green, blue, white and black.
    const std::vector<std::uint8_t> rgba = {255, 0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 255, 255, 255, 0, 0, 0, 0, 0};
    const auto planes = tight(planesOnGpu(rgba, 5, 1, PixelLayout::Yuv444));
    EXPECT_EQ(planes, (std::vector<std::uint8_t>{76, 150, 29, 255, 0, 85, 44, 255, 128, 128, 255, 21, 107, 128, 128}));
}

TEST_F(PlanarYuvTest, ReadBackShrinks) {
    EXPECT_EQ(render::planesOf(PixelLayout::Yuv444, 512, 512).bytes, 3u * 512 * 512);
    EXPECT_EQ(render::planesOf(PixelLayout::Yuv420, 512, 512).bytes, 3u * 512 * 512 / 2);
}

}  // namespace
}  // namespace caustream::tests
