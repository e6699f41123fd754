// map_resolve: no light is lost or made between the fixed-point pyramid and the concentration.
#include "render/passes/map_resolve.h"
#include "tests/gpu/camera_fixture.h"
#include "tests/gpu/light_buffers.h"

namespace caustream::tests {
namespace {

using render::View;

class MapResolveTest : public CameraPass {
   protected:
    struct Resolved {
        std::vector<glm::vec4> concentration;
        std::array<GLuint, layout::kLedgerRows> ledger;
    };
    Resolved resolve(const std::vector<GLuint>& words, const View& view, int levels, double fluxPerFixed = 1.0) {
        const gl::Buffer map(words.size() * sizeof(GLuint), words.data(), GL_DYNAMIC_STORAGE_BIT, "map");
        const gl::Buffer ledger = makeLedger();
        const gl::Texture receivers(kSize, kSize, GL_R32F, "receivers");
        fillTexture(receivers, std::vector<glm::vec4>(kSize * kSize, glm::vec4(0.25f)));
        gl::Texture concentration;
        render::MapResolve(shaders_).run({.map = &map, .view = view, .receivers = receivers, .size = kSize, .levels = levels, .firstTexel = 0,
                                          .xyzToRgb = glm::mat3(1.0f), .fluxPerFixed = fluxPerFixed, .ledgerPerFixed = 1.0, .judged = true},
                                         concentration, ledger);
        glMemoryBarrier(GL_ALL_BARRIER_BITS);   // map and ledger -> read-back
        return {readTexture(concentration), ledgerRows(ledger)};
    }

    static std::size_t firstOf(int level) {
        std::size_t first = 0;
        for (int i = 0; i < level; ++i) first += std::size_t(kSize >> i) * std::size_t(kSize >> i);
        return first;
    }
    static std::vector<GLuint> emptyMap(int levels) { return std::vector<GLuint>(layout::kMapWords * firstOf(levels)); }

    // Parallel, one texel 1 m^2: concentration is flux per texel.
    static View unitView() { return parallelView({0, 0, 3}, {0, 0, 0}, kSize / 2.0f); }
};

TEST_F(MapResolveTest, EveryLevelKeepsItsSumBordersIncluded) {
    for (int level = 0; level < layout::kMostLevels; ++level) {
        const int side = kSize >> level;
        for (const glm::ivec2 texel : {glm::ivec2(0, 0), glm::ivec2(side - 1, 0), glm::ivec2(0, side / 2), glm::ivec2(side - 1, side - 1),
                                       glm::ivec2(side / 2, side / 2), glm::ivec2(1, 1)}) {
            std::vector<GLuint> words = emptyMap(layout::kMostLevels);
            const std::size_t at = layout::kMapWords * (firstOf(level) + std::size_t(texel.y * side + texel.x));
            words[at + layout::kMapX] = 1u << 20, words[at + layout::kMapZ] = 1u << 22;
            words[at + layout::kMapEvenY] = 3u << 19, words[at + layout::kMapEvenY + 1] = 1u << 19;
            const Resolved resolved = resolve(words, unitView(), layout::kMostLevels);
            glm::dvec3 sum(0.0);
            for (const glm::vec4& c : resolved.concentration) sum += glm::dvec3(c);
            // The weights are quarters: nothing rounds below 2^22.
            EXPECT_EQ(sum, glm::dvec3(1u << 20, 1u << 21, 1u << 22)) << "level " << level << " texel " << texel.x << " " << texel.y;
            EXPECT_NEAR(resolved.ledger[layout::kLedgerDeposited], 1u << 21, layout::kLedgerBanks);   // half a unit per group
        }
    }
}

TEST_F(MapResolveTest, CoarseTexelSpreadsAroundItsPlace) {
    std::vector<GLuint> words = emptyMap(3);
    words[layout::kMapWords * (firstOf(2) + 5 * (kSize >> 2) + 9) + layout::kMapEvenY] = 1u << 20;
    const Resolved resolved = resolve(words, unitView(), 3);
    glm::dvec2 centroid(0.0);
    for (int i = 0; i < kSize * kSize; ++i) {
        centroid += glm::dvec2(i % kSize + 0.5, i / kSize + 0.5) * double(resolved.concentration[std::size_t(i)].y) / double(1u << 20);
    }
    EXPECT_NEAR(centroid.x, 9.5 * 4.0, 1e-9);
    EXPECT_NEAR(centroid.y, 5.5 * 4.0, 1e-9);
}

TEST_F(MapResolveTest, BooksWhatTheHalvesDifferByAndHowRoughTheCoarserLevelsAre) {
    // Equal halves, even light: nothing
    std::vector<GLuint> words = emptyMap(2);
    for (std::size_t texel = 0; texel < firstOf(2); ++texel) {
        words[layout::kMapWords * texel + layout::kMapEvenY] = words[layout::kMapWords * texel + layout::kMapEvenY + 1] = 1u << 16;
    }
    Resolved resolved = resolve(words, unitView(), 2);
    EXPECT_EQ(resolved.ledger[layout::kLedgerHalves], 0u);
    EXPECT_EQ(resolved.ledger[layout::kLedgerRoughness], 0u);

    // A texel of the finest level that one half alone brought
    words = emptyMap(2);
    words[layout::kMapWords * (20 * kSize + 30) + layout::kMapEvenY + 1] = 1u << 24;
    resolved = resolve(words, unitView(), 2);
    EXPECT_EQ(resolved.ledger[layout::kLedgerHalves], 1u << 24);
    EXPECT_EQ(resolved.ledger[layout::kLedgerRoughness], 0u);   // no wider than a texel: nothing is blurred

    // A texel of the coarser one, from both: it misses all of its neighbours' mean, its four neighbours a quarter each
    words = emptyMap(2);
    const std::size_t at = layout::kMapWords * (firstOf(1) + 7 * (kSize / 2) + 9);
    words[at + layout::kMapEvenY] = words[at + layout::kMapEvenY + 1] = 1u << 23;
    resolved = resolve(words, unitView(), 2);
    EXPECT_EQ(resolved.ledger[layout::kLedgerHalves], 0u);
    EXPECT_EQ(resolved.ledger[layout::kLedgerRoughness], 2u * (1u << 24) / 16u);
}

TEST_F(MapResolveTest, DirectLightHasConcentrationOne) {
    const double fluxPerFixed = 1e-12;
    const View wide = lookingAt({0, 0, 3}, {0, 0, 0}, 100.0f);   // texels of very different solid angle
    for (const View& view : {unitView(), wide}) {
        std::vector<GLuint> words(layout::kMapWords * kSize * kSize);
        const double unit = view.perspective ? fluxPerFixed : 1e-9;
        for (int i = 0; i < kSize * kSize; ++i) {
            const glm::dvec2 xy = (2.0 * (glm::dvec2(i % kSize, i / kSize) + 0.5) / double(kSize) - 1.0) * glm::dvec2(view.halfExtent);
            const double r2 = 1.0 + glm::dot(xy, xy), area = 4.0 * double(view.halfExtent.x) * double(view.halfExtent.y) / (kSize * kSize);
            const double extent = view.perspective ? area / (r2 * std::sqrt(r2)) : area;
            for (const int word : {layout::kMapX, layout::kMapEvenY, layout::kMapZ}) words[std::size_t(layout::kMapWords * i + word)] = GLuint(std::lround(extent / unit));
        }
        for (const glm::vec4& c : resolve(words, view, 1, unit).concentration) {
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], 1.0f, 2e-6f);   // float rounding of extents and products
            EXPECT_EQ(c.a, 0.25f);                                        // the receiver's layer
        }
    }
}

}  // namespace
}  // namespace caustream::tests
