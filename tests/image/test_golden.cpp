// Whole pictures, linear, against those kept in golden/. CAUSTREAM_UPDATE_GOLDENS=1 in the environment writes them anew: a
// commit of its own, with the reason.
#include <algorithm>
#include <cstdlib>
#include <limits>

#include "scene/builtin_scenes.h"
#include "tests/image/golden.h"
#include "tests/image/image_fixture.h"

namespace caustream::image {
namespace {

class Golden : public ImageTest {
   protected:
    static std::string compare(const std::string& name) {
        const auto scene = scene::loadBuiltin(name);
        if (!scene) return scene.error().message;
        render::Request request = pictureRequest(*scene, render::Sample::F32);
        request.still = true;
        std::vector<float> picture = floats(pipeline().run(request));
        const float white = whitest(picture);
        for (float& value : picture) value /= white;   // whatever the lamp's candela
        if (std::getenv("CAUSTREAM_UPDATE_GOLDENS")) writeGolden(CAUSTREAM_GOLDEN_DIR, name, picture, request.width, request.height);
        return compareWithGolden(CAUSTREAM_GOLDEN_DIR, name, picture, request.width, request.height, kTolerance);
    }

    // What a tenth of the picture is brighter than.
    static float whitest(std::vector<float> values) {
        const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 9 / 10);
        std::nth_element(values.begin(), at, values.end());
        return std::max(*at, 1e-12f);
    }

    static constexpr Tolerance kTolerance = {
        .pixel = 0.02,      // another processor's llvmpipe rounds otherwise: half floats and a caustic's sharp edges
        .fraction = 0.01,   // edges of glass and shadow that fall on the other side of a sample
        .mean = 0.002,      // a tenth of what one sees: a light or a glass that changed shows in all pixels
    };
};

TEST_F(Golden, Gem) { EXPECT_EQ(compare("gem"), ""); }
TEST_F(Golden, Prism) { EXPECT_EQ(compare("prism"), ""); }

// The comparator itself: it sees a spot, a shift in all pixels, a NaN.
TEST_F(Golden, TheComparatorSeesWhatItShould) {
    const auto flat = [](float value) { return std::vector<float>(64 * 64 * 3, value); };
    const Tolerance tolerance{.pixel = 0.02, .fraction = 0.01, .mean = 0.002};
    const std::string folder = testing::TempDir();
    writeGolden(folder, "flat", flat(0.5f), 64, 64);
    EXPECT_EQ(compareWithGolden(folder, "flat", flat(0.5f), 64, 64, tolerance), "");
    EXPECT_THAT(compareWithGolden(folder, "flat", flat(0.51f), 64, 64, tolerance), testing::HasSubstr("mean 0.00999"));
    std::vector<float> spot = flat(0.5f);
    std::fill(spot.begin(), spot.begin() + 3 * 64, 0.6f);
    EXPECT_THAT(compareWithGolden(folder, "flat", spot, 64, 64, tolerance), testing::HasSubstr("(63, 0) is 0.6"));
    spot = flat(0.5f);
    spot[7] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(compareWithGolden(folder, "flat", spot, 64, 64, tolerance), testing::HasSubstr("not finite"));
    EXPECT_THAT(compareWithGolden(folder, "flat", std::vector<float>(3), 1, 1, tolerance), testing::HasSubstr("another size"));
}

}  // namespace
}  // namespace caustream::image
