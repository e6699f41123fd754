// photon_hierarchy: from any number of levels exactly the caster's texels, each once.
#include <algorithm>

#include "render/passes/photon_hierarchy.h"
#include "tests/gpu/camera_fixture.h"

namespace caustream::tests {
namespace {

class PhotonHierarchyTest : public CameraPass {
   protected:
    // x | y << 16 of every photon, in order; what the query counted in `counted`.
    template <class Covered>
    std::vector<GLuint> photons(int side, int levels, Covered&& covered, GLuint& counted) {
        gl::Texture front(side, side, GL_RGBA32F, "front", levels + 1);
        std::vector<glm::vec4> texels;
        for (int i = 0; i < side * side; ++i) texels.emplace_back(0, 0, 1, covered(i % side, i / side) ? 0.01f : 0.0f);
        fillTexture(front, texels);
        GLuint name = 0;
        glCreateQueries(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, 1, &name);
        const gl::Query query(name);
        render::PhotonHierarchy hierarchy(shaders_);
        const render::PhotonPoints& points = hierarchy.run({front, levels, query.get()});
        glGetQueryObjectuiv(query.get(), GL_QUERY_RESULT, &counted);
        std::vector<GLuint> cells(counted);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);   // photons -> read-back
        glGetNamedBufferSubData(points.cells.get(), 0, static_cast<GLsizeiptr>(counted * sizeof(GLuint)), cells.data());
        std::sort(cells.begin(), cells.end());
        return cells;
    }

    template <class Covered>
    static std::vector<GLuint> expected(int side, Covered&& covered) {
        std::vector<GLuint> cells;
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                if (covered(x, y)) cells.push_back(static_cast<GLuint>(x | y << 16));
            }
        }
        return cells;
    }
};

TEST_F(PhotonHierarchyTest, FindsExactlyTheCastersTexels) {
    // A disc, a lone texel in a corner and a line one texel wide: what a coarse cell averages away if it is careless.
    const auto covered = [](int x, int y) {
        return (x - 40) * (x - 40) + (y - 23) * (y - 23) < 150 || (x == 63 && y == 63) || (y == 5 && x > 2);
    };
    for (const int levels : {0, 1, 3, 6}) {
        GLuint counted = 0;
        EXPECT_EQ(photons(64, levels, covered, counted), expected(64, covered)) << levels;
    }
}

TEST_F(PhotonHierarchyTest, NothingAndEverything) {
    GLuint counted = 1;
    EXPECT_TRUE(photons(32, 3, [](int, int) { return false; }, counted).empty());
    EXPECT_EQ(photons(32, 3, [](int, int) { return true; }, counted).size(), 32u * 32u);
}

TEST(HierarchyLevels, HalveTheSideExactly) {
    EXPECT_EQ(render::hierarchyLevels(512, 3), 3);
    EXPECT_EQ(render::hierarchyLevels(512, 6), 6);
    EXPECT_EQ(render::hierarchyLevels(100, 3), 2);
    EXPECT_EQ(render::hierarchyLevels(99, 3), 0);
}

}  // namespace
}  // namespace caustream::tests
