// photon_list: exactly the texels that hold the caster and that the light reaches.
#include <algorithm>

#include "render/coarse_trace.h"
#include "render/passes/photon_list.h"
#include "shaders/shared/layout.h"
#include "tests/gpu/camera_fixture.h"
#include "tests/gpu/light_buffers.h"

namespace caustream::tests {
namespace {

using render::View;

class PhotonListTest : public CameraPass {
   protected:
    struct List {
        std::vector<GLuint> header, texels;   // texels in order
        GLuint booked;
    };
    List list(const gl::Texture& front, const View& emission, const scene::Light& light, GLuint cookie = 0) {
        gl::Buffer buffer;
        const gl::Buffer ledger = makeLedger();
        render::PhotonList(shaders_).run({front, emission, light, cookie}, buffer, ledger);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);   // list -> read-back
        std::vector<GLuint> words = readWords(buffer);
        List result{{words.begin(), words.begin() + layout::kListHeader}, {}, ledgerRows(ledger)[layout::kLedgerPhotons]};
        const auto first = words.begin() + layout::kListHeader;
        result.texels.assign(first, first + std::min<std::ptrdiff_t>(result.header[3], words.end() - first));
        std::sort(result.texels.begin(), result.texels.end());
        return result;
    }

    template <class Covered>
    static gl::Texture layer(int width, int height, Covered&& covered) {
        gl::Texture texture(width, height, GL_RGBA32F, "layer");
        std::vector<glm::vec4> texels;
        for (int i = 0; i < width * height; ++i) texels.emplace_back(0, 0, 1, covered(i % width, i / width) ? 0.01f : 0.0f);
        fillTexture(texture, texels);
        return texture;
    }

    static scene::Light point() {
        scene::Light light = spotAt({0, 0, 3}, {0, 0, -1}, 1.0f);
        light.type = scene::LightType::Point;
        return light;
    }

    static float angleTo(const View& view, int x, int y, int size) {
        const glm::vec2 xy = (2.0f * (glm::vec2(x, y) + 0.5f) / float(size) - 1.0f) * view.halfExtent;
        return glm::degrees(std::atan(glm::length(xy)));
    }

    const View view_ = lookingAt({0, 0, 3}, {0, 0, 0}, 60.0f);
};

TEST_F(PhotonListTest, HalfCoveredLayer) {
    const auto result = list(layer(kSize, kSize, [](int x, int) { return x < kSize / 2; }), view_, point());
    std::vector<GLuint> expected;
    for (GLuint i = 0; i < kSize * kSize; ++i) {
        if (i % kSize < kSize / 2) expected.push_back(i);
    }
    EXPECT_EQ(result.texels, expected);
    EXPECT_EQ(result.booked, expected.size());
    EXPECT_EQ(result.header, (std::vector<GLuint>{GLuint(expected.size()) / layout::kGroupSize, 1, 1, GLuint(expected.size())}));
}

TEST_F(PhotonListTest, SizesThatFillNoGroup) {
    // 63 x 37 ends within a thread's run; 77 photons need a second group that is mostly empty.
    const auto result = list(layer(63, 37, [](int x, int y) { return x >= 56 && y >= 26; }), view_, point());
    EXPECT_EQ(result.texels.size(), 77u);
    EXPECT_EQ(result.texels.back(), 63u * 37u - 1u);
    EXPECT_EQ(result.header[0], 2u);
}

TEST_F(PhotonListTest, NothingThereNothingListed) {
    const auto result = list(layer(kSize, kSize, [](int, int) { return false; }), view_, point());
    EXPECT_EQ(result.header, (std::vector<GLuint>{0, 1, 1, 0}));
    EXPECT_EQ(result.booked, 0u);
}

TEST_F(PhotonListTest, ConeCutsThroughTheLayer) {
    scene::Light light = spotAt({0, 0, 3}, {0, 0, -1}, 1.0f);
    for (const float inner : {17.0f, 5.0f}) {   // a hard and a soft edge reach equally far
        light.innerConeDeg = inner;
        light.outerConeDeg = 17.0f;
        const auto result = list(layer(kSize, kSize, [](int, int) { return true; }), view_, light);
        std::vector<bool> listed(kSize * kSize);
        for (const GLuint texel : result.texels) listed[texel] = true;
        int lit = 0;
        for (int i = 0; i < kSize * kSize; ++i) {
            const float angle = angleTo(view_, i % kSize, i / kSize, kSize);
            if (std::abs(angle - 17.0f) < 0.01f) continue;   // on the edge within float rounding of its cosine
            EXPECT_EQ(listed[std::size_t(i)], angle < 17.0f) << i;
            lit += angle < 17.0f;
        }
        EXPECT_GT(lit, 500);
    }
}

TEST_F(PhotonListTest, CookieTakesWhatItBlackens) {
    scene::Light light = spotAt({0, 0, 3}, {0, 0, -1}, 1.0f);
    light.innerConeDeg = light.outerConeDeg = 45.0f;
    light.cookie = 0;
    const gl::Texture cookie(2, 1, GL_RGBA8, "cookie");   // nearest: left half black, right half white
    const GLubyte texels[] = {0, 0, 0, 255, 255, 255, 255, 255};
    glTextureSubImage2D(cookie.get(), 0, 0, 0, 2, 1, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    const auto result = list(layer(kSize, kSize, [](int, int) { return true; }), view_, light, cookie.get());
    EXPECT_EQ(result.texels.size(), std::size_t(kSize * kSize / 2));
    for (const GLuint texel : result.texels) EXPECT_GE(texel % kSize, GLuint(kSize / 2));
}

}  // namespace
}  // namespace caustream::tests
