// Rays meet casters where brute force in double precision says they do.
#include "scene/builtin_scenes.h"
#include "tests/gpu/exact_surfaces_fixture.h"

namespace caustream::tests {
namespace {

scene::Scene builtin(const std::string& name) {
    auto scene = scene::loadBuiltin(name);
    EXPECT_TRUE(scene) << name;
    return *scene;
}

// From around the casters, at points of their box.
std::vector<TestRay> raysFromOutside(const scene::Bounds& bounds, int count, int inside, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> share(0.0f, 1.0f);
    std::vector<TestRay> rays;
    for (int i = 0; i < count; ++i) {
        TestRay ray;
        ray.inside = inside;
        ray.origin = bounds.centre() + 3.0f * bounds.radius() * randomUnit(random);
        const glm::vec3 at = glm::mix(bounds.min, bounds.max, glm::vec3(share(random), share(random), share(random)));
        ray.direction = glm::normalize(at - ray.origin);
        rays.push_back(ray);
    }
    return rays;
}

class ExactSurfacesAgree : public ExactSurfacesTest {
 protected:
    // Every hit as brute force has it; within a rounding of an edge or a silhouette a neighbour is as good.
    void expectTruth(const scene::Scene& scene, const std::vector<TestRay>& rays, double slack) {
        const render::ExactSurfaces surfaces(scene);
        const auto found = nearest(surfaces, rays);
        int hits = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Truth truth = truthOf(scene, surfaces.casters(), rays[i]);
            if (truth.edge < 1e-4 || truth.second - truth.t < 10.0 * slack) continue;
            ASSERT_EQ(found[i].caster, truth.caster) << "ray " << i << " t " << truth.t << " edge " << truth.edge;
            if (truth.caster < 0) continue;
            ++hits;
            ASSERT_NEAR(found[i].t, truth.t, slack) << "ray " << i;
            const glm::dvec3 point = glm::dvec3(rays[i].origin) + truth.t * glm::dvec3(rays[i].direction);
            ASSERT_LT(glm::distance(glm::dvec3(found[i].point), point), 2.0 * slack) << "ray " << i;
            ASSERT_LT(glm::distance(glm::dvec3(found[i].geometric), truth.geometric), 2e-5) << "ray " << i;
            if (!surfaces.casters()[static_cast<std::size_t>(truth.caster)].convex) {
                ASSERT_LT(glm::distance(glm::dvec3(found[i].shading), truth.shading), 2e-3) << "ray " << i;
            }
        }
        EXPECT_GT(hits, static_cast<int>(rays.size()) / 10);
    }
};

TEST_F(ExactSurfacesAgree, OnBuiltinCastersFromOutside) {
    for (const auto& [name, count] : std::map<std::string, int>{{"gem", 2000}, {"prism", 2000}, {"sphere", 1000}, {"ring", 100}, {"bunny", 100}}) {
        SCOPED_TRACE(name);
        const scene::Scene scene = builtin(name);
        for (const int inside : {kEmpty, -2}) expectTruth(scene, raysFromOutside(scene.geometry->casterBounds, count, inside, 1), 5e-6);
    }
}

TEST_F(ExactSurfacesAgree, OnBuiltinCastersFromInside) {
    for (const auto& [name, count] : std::map<std::string, int>{{"gem", 2000}, {"prism", 2000}, {"sphere", 1000}, {"bunny", 60}}) {
        SCOPED_TRACE(name);
        const scene::Scene scene = builtin(name);
        const render::ExactSurfaces surfaces(scene);
        auto rays = raysFromOutside(scene.geometry->casterBounds, count, kEmpty, 2);
        const auto entered = nearest(surfaces, rays);
        std::vector<TestRay> within;
        std::mt19937 random(3);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (entered[i].caster < 0) continue;
            glm::vec3 direction = randomUnit(random);
            if (glm::dot(direction, glm::vec3(entered[i].geometric)) > 0.0f) direction = -direction;
            within.push_back({glm::vec3(entered[i].point) - 1e-4f * glm::vec3(entered[i].geometric), -1, direction, entered[i].caster});
        }
        expectTruth(scene, within, 5e-6);
    }
}

}  // namespace
}  // namespace caustream::tests
