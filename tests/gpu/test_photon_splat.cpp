// photon_splat: what a photon adds to the map, on glass with the index of what is around it, so that it goes straight on.
#include "render/map_energy.h"
#include "render/passes/photon_splat.h"
#include "tests/gpu/camera_fixture.h"

namespace caustream::tests {
namespace {

class PhotonSplatTest : public CameraPass {
   protected:
    // The map after one photon from texel (x, y) of a grid of 32, whose receiver is a plane across the view.
    gl::Texture splat(int x, int y, int mapSize, const std::vector<render::PhotonSplat::Wavelength>& wavelengths, bool alpha = false) {
        const auto image = [&](GLenum format, const char* label, float layer, bool all) {
            gl::Texture texture(kGrid, kGrid, format, label);
            std::vector<glm::vec4> texels;
            for (int i = 0; i < kGrid * kGrid; ++i) {
                const bool here = all || (i % kGrid == x && i / kGrid == y);
                texels.emplace_back(0, 0, all ? -1 : 1, here ? layer : 0.0f);
            }
            fillTexture(texture, texels);
            return texture;
        };
        const gl::Texture front = image(GL_RGBA32F, "front", view_.nearM / 1.0f, false);
        const gl::Texture back = image(GL_RGBA32F, "back", view_.nearM / 1.2f, true);
        gl::Texture receivers(kGrid, kGrid, GL_R32F, "receivers");
        fillTexture(receivers, std::vector<glm::vec4>(kGrid * kGrid, glm::vec4(view_.nearM / 3.0f, 0, 0, 0)));
        render::PhotonHierarchy hierarchy(shaders_);
        const render::PhotonPoints& photons = hierarchy.run({front, 0});
        gl::Texture map(mapSize, mapSize, GL_RGBA32F, "map");
        const float clear[4] = {0, 0, 0, alpha ? 0.0f : 1.0f};
        glClearTexImage(map.get(), 0, GL_RGBA, GL_FLOAT, clear);
        render::PhotonSplat(shaders_).run({front, back, receivers, view_, photons, light(), 0, wavelengths}, alpha, map);
        return map;
    }

    scene::Light light() const {
        scene::Light light = spotAt({0, 0, 3}, {0, 0, -1}, 1.0f);
        light.type = scene::LightType::Point;
        return light;
    }

    static constexpr int kGrid = 32;
    const render::View view_ = lookingAt({0, 0, 3}, {0, 0, 0}, 40.0f);
};

// The printed Gaussian is normalised for the mean over where a splat's centre may lie: .993 there (its integral), more or
// less by how many pixels' middles it covers.
TEST_F(PhotonSplatTest, TheGaussianSumsToOneUnitOfFlux) {
    double sum = 0.0;
    int count = 0;
    for (int mapSize = 40; mapSize < 104; ++mapSize) {
        const gl::Texture map = splat(9 + mapSize % 7, 12 + mapSize % 5, mapSize, {{1.0f, glm::vec4(1, 1, 1, 0)}});
        const int texel = (12 + mapSize % 5) * kGrid + 9 + mapSize % 7;
        const double units = render::mapFlux(map, view_) / render::texelExtent(view_, kGrid, texel);
        EXPECT_NEAR(units, 1.0, 0.12) << mapSize;
        sum += units, ++count;
    }
    EXPECT_NEAR(sum / count, 0.993, 0.01);
}

TEST_F(PhotonSplatTest, LandsWhereItWasAimedAndWeighsItsWavelengths) {
    const std::vector<glm::vec4> texels = readTexture(splat(20, 8, kGrid, {{1.0f, {1, 0, 0, 0}}, {1.0f, {0, 0.5f, 0, 0}}}));
    const glm::vec4 centre = texels[8 * kGrid + 20];
    EXPECT_NEAR(centre.r, 0.918f / 2.625f, 1e-3f);   // the printed alpha over its normalizeFactor
    EXPECT_NEAR(centre.g, 0.5f * centre.r, 1e-5f);
    EXPECT_EQ(centre.b, 0.0f);
    EXPECT_EQ(centre.a, 1.0f);   // the receiver's layer, untouched
    EXPECT_NEAR(texels[8 * kGrid + 21].r, texels[8 * kGrid + 19].r, 2e-3f);
    EXPECT_EQ(texels[8 * kGrid + 22].r, 0.0f);       // 1.25 pixels and no farther
    EXPECT_TRUE(allFinite(texels));
}

TEST_F(PhotonSplatTest, AFourthBandTakesAlpha) {
    const std::vector<glm::vec4> texels = readTexture(splat(20, 8, kGrid, {{1.0f, {0, 0, 0, 1}}}, true));
    EXPECT_NEAR(texels[8 * kGrid + 20].a, 0.918f / 2.625f, 1e-3f);
}

TEST_F(PhotonSplatTest, TwentyOneWavelengthsFitOneDraw) {
    const std::vector<render::PhotonSplat::Wavelength> many(21, {1.0f, glm::vec4(1.0f / 21.0f)});
    EXPECT_NEAR(readTexture(splat(20, 8, kGrid, many))[8 * kGrid + 20].g, 0.918f / 2.625f, 1e-3f);
}

}  // namespace
}  // namespace caustream::tests
