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

// The corners of the first caster's triangles, three by three.
std::vector<glm::vec3> cornersOf(const scene::Scene& scene, const render::ExactSurfaces& surfaces) {
    const scene::Object& object = scene.geometry->objects[surfaces.casters()[0].object];
    std::vector<glm::vec3> corners;
    for (std::uint32_t i = 0; i < object.indexCount; ++i) {
        corners.push_back(scene.geometry->vertices[scene.geometry->indices[object.firstIndex + i]].position);
    }
    return corners;
}

// From points inside exactly at corners and points of edges: whichever side a rounding takes them to, a surface is there.
class ExactSurfacesHold : public ExactSurfacesTest {
 protected:
    void expectNoWayOut(const scene::Scene& scene, const glm::vec3& centre, float radius, int count) {
        const render::ExactSurfaces surfaces(scene);
        const std::vector<glm::vec3> corners = cornersOf(scene, surfaces);
        std::mt19937 random(5);
        std::uniform_real_distribution<float> share(0.0f, 1.0f);
        std::vector<TestRay> rays;
        for (int i = 0; i < count; ++i) {
            const std::size_t corner = random() % corners.size(), next = corner % 3 == 2 ? corner - 2 : corner + 1;
            const glm::vec3 at = i % 2 ? corners[corner] : glm::mix(corners[corner], corners[next], share(random));
            TestRay ray;
            ray.origin = centre + radius * share(random) * randomUnit(random);
            ray.direction = glm::normalize(at - ray.origin);
            ray.inside = 0;
            rays.push_back(ray);
        }
        const auto found = nearest(surfaces, rays);
        int lost = 0;
        for (const TestSurface& surface : found) lost += surface.caster != 0;
        EXPECT_EQ(lost, 0) << "of " << count;
    }
};

TEST_F(ExactSurfacesHold, ThroughEdgesAndCorners) {
    const scene::Scene sphere = builtin("sphere"), gem = builtin("gem");
    const scene::Bounds& ball = sphere.geometry->casterBounds;
    expectNoWayOut(sphere, ball.centre(), 0.5f * (ball.max.x - ball.min.x) * 0.9f, 1'000'000);
    expectNoWayOut(gem, gem.geometry->casterBounds.centre(), 0.01f, 100'000);
}

// A ring of slivers: 20,000 times as long as wide, tilted, seen from its middle.
TEST_F(ExactSurfacesHold, ThroughSlivers) {
    SyntheticScene made;
    std::vector<glm::vec3> corners;
    constexpr int kAround = 30'000;
    const auto at = [](int i, float y) {
        const float angle = glm::two_pi<float>() * float(i % kAround) / float(kAround);
        return glm::vec3(0.5f * std::cos(angle) + 0.2f * y, y, 0.5f * std::sin(angle));
    };
    for (int i = 0; i < kAround; ++i) {
        for (const glm::vec3& p : {at(i, -1), at(i, 1), at(i + 1, 1), at(i, -1), at(i + 1, 1), at(i + 1, -1)}) corners.push_back(p);
    }
    made.addFlat(made.material(glass()), corners);
    const scene::Scene scene = sceneOf(made);
    const render::ExactSurfaces surfaces(scene);
    ASSERT_FALSE(surfaces.casters()[0].convex);
    std::mt19937 random(6);
    std::vector<TestRay> rays;
    for (int i = 0; i < 20'000; ++i) {
        glm::vec3 direction = randomUnit(random);
        direction.y *= 0.5f;
        rays.push_back({0.2f * randomUnit(random), -1, glm::normalize(direction), 0});
    }
    const auto found = nearest(surfaces, rays);
    int lost = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const float rise = std::abs(rays[i].direction.y) / std::hypot(rays[i].direction.x, rays[i].direction.z);
        lost += rise < 0.6f && found[i].caster != 0;
    }
    EXPECT_EQ(lost, 0);
}

// 32 reflections inside: always met again, on the caster, and on the way. (length, meetings, short steps, farthest from
// the middle) of each walk.
TEST_F(ExactSurfacesHold, ForThirtyTwoInternalReflections) {
    const std::string walk =
        "    ivec4 none = ivec4(0x7fffffff);\n"
        "    vec3 origin = a.xyz, direction = b.xyz;\n    Surface s = nearestSurface(origin, direction, -1, none);\n"
        "    float length_ = 0.0, meetings = 0.0, shorts = 0.0, farthest = 0.0;\n"
        "    bool hit = s.caster == 0;\n    if (hit) direction = refract(direction, s.geometric, 1.0 / 1.5);\n"
        "    for (int bounce = 0; bounce < 33 && s.caster == 0; ++bounce) {\n"
        "        origin = s.point;\n        s = nearestSurface(origin, direction, s.piece, ivec4(0, none.yzw));\n"
        "        if (s.caster != 0) break;\n"
        "        length_ += s.t;\n        meetings += 1.0;\n        shorts += s.t < 1e-5 ? 1.0 : 0.0;\n"
        "        farthest = max(farthest, distance(s.point, vec3(a.w, b.w, 0)));\n"
        "        vec3 thrown = reflect(direction, s.shading);\n"
        "        direction = dot(thrown, s.geometric) < 0.0 ? thrown : reflect(direction, s.geometric);\n"
        "    }\n"
        "    outputs[i] = hit ? vec4(length_, meetings, shorts, farthest) : vec4(-1);\n";
    for (const auto& [name, count] : std::map<std::string, int>{{"gem", 20'000}, {"prism", 20'000}, {"sphere", 20'000}, {"ring", 2000}, {"bunny", 2000}}) {
        SCOPED_TRACE(name);
        const scene::Scene scene = builtin(name);
        const render::ExactSurfaces surfaces(scene);
        const scene::Bounds& bounds = scene.geometry->casterBounds;
        std::vector<glm::vec4> inputs;
        for (const TestRay& ray : raysFromOutside(bounds, count, kEmpty, 7)) {
            inputs.emplace_back(ray.origin, bounds.centre().x);
            inputs.emplace_back(ray.direction, bounds.centre().y);
        }
        const auto walks = compute(surfaces, "", walk, inputs, 1);
        int walked = 0, lost = 0, stuck = 0;
        for (const glm::vec4& one : walks) {
            if (one.x < 0.0f) continue;
            ++walked;
            lost += one.y != 33.0f;
            stuck += one.z > 8.0f || one.x < 0.05f * bounds.radius();
            ASSERT_LT(one.w, bounds.radius() + std::abs(bounds.centre().z) + 1e-3f);
        }
        EXPECT_GT(walked, count / 10);
        EXPECT_EQ(lost, 0) << "of " << walked;
        EXPECT_LE(stuck, walked / 1000) << "of " << walked;
    }
}

// Software GL ends an invocation's loops after 65,535 turns; from then on nothing is known, and nothing is made up.
TEST_F(ExactSurfacesHold, OrSayThatTheyAreLost) {
    const scene::Scene scene = builtin("sphere");
    const render::ExactSurfaces surfaces(scene);
    const std::string work =
        "    int met = 0, lost = 0, wrong = 0;\n"
        "    for (int k = 0; k < 4000; ++k) {\n"
        "        vec3 way = normalize(vec3(sin(float(k)), cos(1.7 * float(k)), sin(0.3 * float(k) + 1.0)) + 1e-3);\n"
        "        int caster = nearestSurface(a.xyz, way, -1, ivec4(0, ivec3(0x7fffffff))).caster;\n"
        "        if (caster == 0) ++met;\n        else if (caster == kLost) ++lost;\n        else ++wrong;\n"
        "    }\n"
        "    outputs[i] = vec4(met, lost, wrong, 0);\n";
    const auto found = compute(surfaces, "", work, {glm::vec4(scene.geometry->casterBounds.centre(), 0), glm::vec4(0)}, 1);
    EXPECT_GT(found[0].x, 300.0f);
    EXPECT_EQ(found[0].z, 0.0f) << found[0].x << " met, " << found[0].y << " lost";
    RecordProperty("met", static_cast<int>(found[0].x));
    RecordProperty("lost", static_cast<int>(found[0].y));
}

// Which surfaces a straight ray meets, with the casters it is in kept: caster + 1, negative when it is left.
class ExactSurfacesInOrder : public ExactSurfacesTest {
 protected:
    static constexpr int kMost = 8;
    std::vector<std::vector<int>> orders(const render::ExactSurfaces& surfaces, const std::vector<TestRay>& rays) {
        std::vector<glm::vec4> inputs;
        for (const TestRay& ray : rays) {
            inputs.emplace_back(ray.origin, 0.0f);
            inputs.emplace_back(ray.direction, 0.0f);
        }
        const auto values = compute(surfaces, "",
                                    "    ivec4 inside = ivec4(0x7fffffff);\n    vec3 origin = a.xyz;\n    int from = -1;\n"
                                    "    for (int k = 0; k < 8; ++k) {\n"
                                    "        Surface s = nearestSurface(origin, b.xyz, from, inside);\n"
                                    "        int met = 0;\n"
                                    "        if (s.caster >= 0) {\n"
                                    "            bool entering = dot(b.xyz, s.geometric) < 0.0;\n"
                                    "            met = entering ? s.caster + 1 : -s.caster - 1;\n"
                                    "            inside[s.caster] = entering ? s.caster : 0x7fffffff;\n"
                                    "            origin = s.point;\n            from = s.piece;\n"
                                    "        }\n"
                                    "        outputs[8 * i + k] = vec4(met, s.t, 0, 0);\n"
                                    "    }\n",
                                    inputs, kMost);
        std::vector<std::vector<int>> result(rays.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (values[i].x != 0.0f) result[i / kMost].push_back(static_cast<int>(values[i].x));
        }
        return result;
    }
};

// Boxes as planes or, with an interpolated normal somewhere, as triangles.
void addBox(SyntheticScene& made, bool planes, const glm::vec3& low, const glm::vec3& high) {
    made.addBox(made.material(glass()), low, high);
    if (!planes) made.edit().vertices.back().normal = glm::normalize(glm::vec3(1, 1, 1));
}

TEST_F(ExactSurfacesInOrder, OfTouchingNestedAndOverlappingCasters) {
    for (int forms = 0; forms < 8; ++forms) {
        SCOPED_TRACE(forms);
        SyntheticScene made;
        addBox(made, forms & 1, {-1, -1, -1}, {0.3f, 1, 1});          // 0 touches 1 at a shared face
        addBox(made, forms & 2, {0.3f, -1, -1}, {1.1f, 1, 1});
        addBox(made, forms & 4, {0.5f, -0.5f, -0.5f}, {0.9f, 0.5f, 0.5f});   // 2 within 1
        addBox(made, forms & 1, {1.0f, -0.8f, -0.8f}, {2, 0.8f, 0.8f});      // 3 overlaps 1
        const scene::Scene scene = sceneOf(made);
        const render::ExactSurfaces surfaces(scene);
        EXPECT_EQ(surfaces.casters()[0].convex, (forms & 1) != 0);
        std::mt19937 random(8);
        std::uniform_real_distribution<float> across(-0.4f, 0.4f), tilt(-0.03f, 0.03f);
        std::vector<TestRay> rays;
        for (int i = 0; i < 4000; ++i) {
            const float side = i % 2 ? -1.0f : 1.0f;
            // Some run exactly along a diagonal of the sides, where their two triangles meet.
            const glm::vec3 origin = i % 8 == 0 ? glm::vec3(-5, 0.25f, 0.25f) : glm::vec3(-5.0f * side, across(random), across(random));
            const glm::vec3 direction = i % 8 == 0 ? glm::vec3(1, 0, 0) : glm::normalize(glm::vec3(side, tilt(random) * 0.5f, tilt(random) * 0.5f));
            rays.push_back({origin, -1, direction});
        }
        const auto found = orders(surfaces, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            // Where they touch, either may come first.
            std::vector<int> forwards{1, -1, 2, 3, -3, 4, -2, -4}, backwards{4, 2, -4, 3, -3, -2, 1, -1};
            std::vector<int> also = rays[i].direction.x > 0.0f ? forwards : backwards;
            std::swap(also[rays[i].direction.x > 0.0f ? 1 : 5], also[rays[i].direction.x > 0.0f ? 2 : 6]);
            EXPECT_THAT(found[i], testing::AnyOf(rays[i].direction.x > 0.0f ? forwards : backwards, also)) << "ray " << i;
            if (HasFailure()) break;
        }
    }
}

TEST_F(ExactSurfacesInOrder, OfAMeshThatRaysEnterTwice) {
    const scene::Scene ring = builtin("ring");
    const render::ExactSurfaces surfaces(ring);
    const auto rays = raysFromOutside(ring.geometry->casterBounds, 3000, kEmpty, 9);
    const auto found = orders(surfaces, rays);
    int twice = 0;
    for (const auto& order : found) {
        EXPECT_TRUE(order == (std::vector<int>{1, -1}) || order == (std::vector<int>{1, -1, 1, -1}) || order.empty());
        twice += order.size() == 4;
    }
    EXPECT_GT(twice, 100);
}

TEST_F(ExactSurfacesTest, ReceiversAreMetFromBothSidesAndWhereACasterStandsOnThem) {
    SyntheticScene made;
    made.addQuad(made.material(matte({1, 1, 1})), {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
    made.addBox(made.material(glass()), {-0.1f, 0, -0.1f}, {0.1f, 0.2f, 0.1f});
    const scene::Scene scene = sceneOf(made);
    const render::ExactSurfaces surfaces(scene);
    const std::vector<glm::vec4> inputs{{0.3f, 2, 0.1f, 0}, {0, -1, 0, 0}, {0.3f, -2, 0.1f, 0}, {0, 1, 0, 0},
                                        {0.05f, 0, 0.02f, 0}, {0.6f, -0.8f, 0, 0}, {0, 1, 0, 0}, {0, 1, 0, 0}};
    const auto found = compute(surfaces, "", "    Ground g = nearestReceiver(a.xyz, b.xyz);\n    outputs[i] = vec4(g.t, g.object, g.geometric.y, 0);\n",
                               inputs, 1, true);
    EXPECT_EQ(found[0], glm::vec4(2, 0, 1, 0));
    EXPECT_EQ(found[1], glm::vec4(2, 0, 1, 0));
    EXPECT_EQ(found[2], glm::vec4(0, 0, 1, 0));
    EXPECT_EQ(found[3].y, -1.0f);
}

// Of one part in a million of the scene, or less: too near to be seen, far enough to be beyond.
TEST_F(ExactSurfacesTest, LeavingIsToTheSideThatTheDirectionGoesTo) {
    SyntheticScene made;
    made.addSphere(made.material(glass()), {0.2f, 1, 0.1f}, 0.5f);
    const scene::Scene scene = sceneOf(made);
    const render::ExactSurfaces surfaces(scene);
    std::mt19937 random(10);
    std::vector<glm::vec4> inputs;
    for (int i = 0; i < 500; ++i) {
        const glm::vec3 normal = randomUnit(random);
        inputs.emplace_back(glm::vec3(0.2f, 1, 0.1f) + 0.5f * normal, 0.0f);
        inputs.emplace_back(randomUnit(random), 0.0f);
    }
    const auto found = compute(surfaces, "", "    outputs[i] = vec4(leaving(a.xyz, normalize(a.xyz - vec3(0.2, 1, 0.1)), b.xyz), 0);\n", inputs, 1);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const glm::vec3 point(inputs[2 * i]), normal = glm::normalize(point - glm::vec3(0.2f, 1, 0.1f)), direction(inputs[2 * i + 1]);
        const float away = glm::dot(glm::vec3(found[i]) - point, normal);
        EXPECT_GT(away * glm::dot(direction, normal), 0.0f);
        EXPECT_LT(std::abs(away), 1e-4f);
    }
}

}  // namespace
}  // namespace caustream::tests
