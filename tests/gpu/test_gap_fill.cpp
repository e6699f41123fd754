// gap_fill's running sums against the thesis's loops (Blanchette 2012, appendix A), as they stand there.
#include <random>

#include "render/passes/gap_fill.h"
#include "tests/gpu/camera_fixture.h"

namespace caustream::tests {
namespace {

class GapFillTest : public CameraPass {
   protected:
    using Map = std::vector<glm::vec4>;

    static glm::vec3 at(const Map& map, int x, int y) {
        return x < 0 || y < 0 || x >= kSize || y >= kSize ? glm::vec3(0.0f) : glm::vec3(map[std::size_t(y * kSize + x)]);
    }

    static bool lit(const glm::vec3& c) { return c.r > 0.1f || c.g > 0.1f || c.b > 0.1f; }

    // Both sides of one texel along `step`.
    static glm::vec3 check(const Map& map, int x, int y, const glm::ivec2& step) {
        glm::vec3 after(0.0f), before(0.0f);
        for (int i = 1; i < 20; ++i) after += at(map, x + i * step.x, y + i * step.y);
        for (int i = 1; i < 20; ++i) before += at(map, x - i * step.x, y - i * step.y);
        return lit(after) && lit(before) ? 0.5f * (after + before) * 0.2f : glm::vec3(0.0f);
    }

    static Map fillOnCpu(const Map& map) {
        Map filled = map;
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                const glm::vec3 here = at(map, x, y);
                if (here.r >= 0.3f || here.g >= 0.3f || here.b >= 0.3f) continue;
                filled[std::size_t(y * kSize + x)] = glm::vec4(0.5f * (check(map, x, y, {0, 1}) + check(map, x, y, {1, 0})), map[std::size_t(y * kSize + x)].a);
            }
        }
        return filled;
    }

    Map fill(const Map& map) {
        gl::Texture texture(kSize, kSize, GL_RGBA32F, "map");
        fillTexture(texture, map);
        render::GapFill(shaders_).run(texture);
        return readTexture(texture);
    }

    static void expectEqual(const Map& got, const Map& expected) {
        for (std::size_t i = 0; i < got.size(); ++i) {
            // Sums of multiples of 1/64 are exact; what remains is the product with 0.2.
            EXPECT_LT(glm::distance(glm::vec3(got[i]), glm::vec3(expected[i])), 1e-5f) << i % kSize << " " << i / kSize;
            EXPECT_EQ(got[i].a, expected[i].a);   // the receiver's layer, not light
        }
    }
};

TEST_F(GapFillTest, RandomSparseMap) {
    std::mt19937 random(5);
    Map map(kSize * kSize, glm::vec4(0, 0, 0, 0.5f));
    for (int i = 0; i < 150; ++i) {
        glm::vec4& texel = map[random() % map.size()];
        for (int k = 0; k < 3; ++k) texel[k] = float(random() % 96) / 64.0f;
    }
    expectEqual(fill(map), fillOnCpu(map));
}

TEST_F(GapFillTest, BandsWithGapsBetween) {
    Map map(kSize * kSize, glm::vec4(0, 0, 0, 1));
    for (int i = 0; i < kSize * kSize; ++i) {
        const int x = i % kSize;
        if (x >= 10 && x < 12) map[std::size_t(i)] = {1, 0, 0, 1};
        if (x >= 25 && x < 27) map[std::size_t(i)] = {0, 1, 0, 1};
        if (x >= 60) map[std::size_t(i)] = {0, 0, 1, 1};
    }
    const Map filled = fill(map);
    expectEqual(filled, fillOnCpu(map));
    // Between red and green, two texels of either in the row and nothing in the column: half of half of 2 * 0.2.
    EXPECT_NEAR(filled[32 * kSize + 18].r, 0.1f, 1e-6f);
    EXPECT_NEAR(filled[32 * kSize + 18].g, 0.1f, 1e-6f);
    EXPECT_EQ(glm::vec3(filled[32 * kSize + 50]), glm::vec3(0.0f));   // farther than it looks from green
}

TEST_F(GapFillTest, EmptyStaysEmptyAndFullStaysFull) {
    const Map empty(kSize * kSize, glm::vec4(0, 0, 0, 1)), full(kSize * kSize, glm::vec4(0.5f, 0.5f, 0.5f, 1));
    expectEqual(fill(empty), empty);
    expectEqual(fill(full), full);
}

}  // namespace
}  // namespace caustream::tests
