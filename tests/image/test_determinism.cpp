// Same input, same bits.
#include <cstdio>
#include <cstdlib>

#include "scene/builtin_scenes.h"
#include "tests/image/image_fixture.h"

namespace caustream::image {
namespace {

class Determinism : public ImageTest {
   protected:
    // Of a copy of the scene, so that nothing comes from a cache.
    static std::uint64_t hashOf(render::Pipeline& pipeline, const scene::Scene& scene) {
        static std::vector<std::shared_ptr<const scene::Geometry>> kept;   // no address may come again
        scene::Scene copy = scene;
        copy.geometry = kept.emplace_back(std::make_shared<scene::Geometry>(*scene.geometry));
        render::Request request = mapRequest(copy);
        request.still = true;
        return pipeline.run(request).mapHash;
    }

    static std::string hashOfProcess(int threads) {
        const std::string command = "LP_NUM_THREADS=" + std::to_string(threads) + " " + CAUSTREAM_MAP_HASH;
        std::string line;
        std::FILE* pipe = popen(command.c_str(), "r");
        if (!pipe) return "popen failed";
        char text[64] = {};
        if (std::fgets(text, sizeof text, pipe)) line = text;
        return pclose(pipe) == 0 ? line : "failed: " + line;
    }
};

TEST_F(Determinism, TenRunsAndAFreshPipeline) {
    const auto gem = scene::loadBuiltin("gem");
    ASSERT_TRUE(gem);
    const std::uint64_t first = hashOf(pipeline(), *gem);
    EXPECT_NE(first, 0u);
    for (int i = 1; i < 10; ++i) {
        if (i == 5) hashOf(pipeline(), sphereScene(optics::Cauchy{1.7, 0.01}));   // something else in between
        EXPECT_EQ(hashOf(pipeline(), *gem), first) << i;
    }
    EXPECT_EQ(hashOf(*freshPipeline(), *gem), first);
}

TEST_F(Determinism, AnotherSceneHasAnotherHash) {
    EXPECT_NE(hashOf(pipeline(), sphereScene(optics::Cauchy{1.5, 0.01})), hashOf(pipeline(), sphereScene(optics::Cauchy{1.5, 0.011})));
}

TEST_F(Determinism, RasteriserThreadsDoNotMatter) {
    const std::string one = hashOfProcess(1);
    EXPECT_EQ(one.size(), 17u) << one;
    EXPECT_EQ(hashOfProcess(2), one);
    EXPECT_EQ(hashOfProcess(0), one);
}

}  // namespace
}  // namespace caustream::image
