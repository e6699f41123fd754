// Stiff and extreme cases: finite values, energy within the ledger.
#include <glm/gtc/constants.hpp>

#include "scene/builtin_scenes.h"
#include "tests/image/image_fixture.h"

namespace caustream::image {
namespace {

// Runs map and picture; the map's ledger.
class Extremes : public ImageTest {
   protected:
    static render::EnergyLedger check(const scene::Scene& scene) {
        render::Request request = mapRequest(scene);
        const render::Frame map = pipeline().run(request);
        EXPECT_TRUE(allFinite(floats(map)));
        EXPECT_LE(ledgerGap(map.stats.ledger), 1e-4);
        EXPECT_TRUE(allFinite(floats(pipeline().run(pictureRequest(scene, render::Sample::F32)))));
        request.wavelengthBands = true;
        const render::Frame bands = pipeline().run(request);
        EXPECT_TRUE(allFinite(floats(bands)));
        EXPECT_LE(ledgerGap(bands.stats.ledger), 1e-4);
        return map.stats.ledger;
    }

    // Everything about the origin, light and camera included.
    static scene::Scene scaled(scene::Scene scene, float by) {
        auto geometry = std::make_shared<scene::Geometry>(*scene.geometry);
        const auto scale = [by](scene::Bounds& bounds) { bounds.min *= by, bounds.max *= by; };
        for (scene::Vertex& vertex : geometry->vertices) vertex.position *= by;
        for (scene::Object& object : geometry->objects) scale(object.bounds);
        scale(geometry->bounds), scale(geometry->casterBounds);
        scene.geometry = geometry;
        for (scene::Light& light : scene.lights) light.position *= by, light.intensity *= by * by;
        for (scene::Camera& camera : scene.cameras) camera.eye *= by, camera.target *= by;
        return scene;
    }

    template <class Change>
    static scene::Scene changed(scene::Scene scene, Change&& change) {
        auto geometry = std::make_shared<scene::Geometry>(*scene.geometry);
        change(*geometry);
        scene.geometry = geometry;
        return scene;
    }

    static scene::Scene sphere() { return sphereScene(optics::Cauchy{1.5046, 0.0042}); }
};

TEST_F(Extremes, EveryBuiltInSceneClosesItsLedger) {
    for (const scene::BuiltinScene& builtin : scene::builtinScenes()) {
        const auto scene = scene::loadBuiltin(builtin.name);
        ASSERT_TRUE(scene) << builtin.name;
        const render::Frame frame = pipeline().run(mapRequest(*scene));
        EXPECT_LE(ledgerGap(frame.stats.ledger), 1e-4) << builtin.name;
        EXPECT_GT(frame.stats.ledger.deposited, 0.05 * frame.stats.ledger.onCasters) << builtin.name;
        EXPECT_TRUE(allFinite(floats(frame))) << builtin.name;
    }
}

TEST_F(Extremes, TheThesissExaggeratedGlass) {
    const auto ledger = check(sphereScene(optics::Cauchy{1.458, 0.6}));   // n = 5.6 at 380 nm
    EXPECT_GT(ledger.deposited, 0.0);
}

TEST_F(Extremes, AlmostNoInterface) {
    const auto ledger = check(sphereScene(optics::Cauchy{1.0003, 0.0}));
    EXPECT_GT(ledger.deposited, 0.98 * ledger.onCasters);
}

TEST_F(Extremes, LightInsideTheCaster) {
    scene::Scene scene = sphere();
    scene.lights.front().position = {0, 0.5f, 0};
    check(scene);
}

TEST_F(Extremes, LightTouchingTheCaster) {
    scene::Scene scene = sphere();
    scene.lights.front() = spotAbove({0, 0.8f, 0}, {0, 0, 0}, 60.0f);
    check(scene);
    scene.lights.front() = spotAbove({0, 0.8001f, 0}, {0, 0, 0}, 60.0f);
    check(scene);
}

TEST_F(Extremes, CasterOfOneTexel) {
    scene::Scene scene = changed(sphere(), [](scene::Geometry& geometry) {
        scene::Bounds bounds;
        for (std::uint32_t i = 0; i < geometry.objects[0].indexCount; ++i) {
            scene::Vertex& vertex = geometry.vertices[geometry.indices[i]];
            vertex.position = glm::vec3(0, 0.5f, 0) + 1e-4f * vertex.normal;
            bounds.add(vertex.position);
        }
        geometry.objects[0].bounds = geometry.casterBounds = bounds;
    });
    check(scene);
}

TEST_F(Extremes, TheSameAtAnyScale) {
    const auto metres = check(sphere());
    for (const float by : {1e-3f, 1e4f}) {
        const auto ledger = check(scaled(sphere(), by));
        EXPECT_NEAR(ledger.onCasters / metres.onCasters, 1.0, 1e-3) << by;
        EXPECT_NEAR(ledger.deposited / metres.deposited, 1.0, 5e-3) << by;
    }
}

TEST_F(Extremes, CasterThatFillsTheView) {
    scene::Scene scene = sphere();
    scene.lights.front() = spotAbove({0, 0.85f, 0}, {0, 0, 0}, 20.0f);
    scene.cameras.front().eye = {0, 0.5f, 0.31f};
    scene.cameras.front().target = {0, 0.5f, 0};
    check(scene);
}

TEST_F(Extremes, NoReceiver) {
    tests::SyntheticScene parts;
    parts.addSphere(parts.material(glassOf(optics::Cauchy{})), {0, 0.5f, 0}, 0.3f);
    const auto ledger = check(finish(parts, spotAbove({0, 2, 0}, {0, 0, 0}, 20.0f)));
    EXPECT_EQ(ledger.deposited, 0.0);
}

TEST_F(Extremes, NoCaster) {
    tests::SyntheticScene parts;
    addFloor(parts);
    const auto ledger = check(finish(parts, spotAbove({0, 2, 0}, {0, 0, 0}, 20.0f)));
    EXPECT_EQ(ledger.onCasters, 0.0);
}

TEST_F(Extremes, ReceiverEdgeOnToTheLight) {
    tests::SyntheticScene parts;
    parts.addSphere(parts.material(glassOf(optics::Cauchy{1.5, 0.01})), {0, 0.5f, 0}, 0.3f);
    parts.addQuad(parts.material(white()), {0, -5, -5}, {0, 10, 0}, {0, 0, 10});
    check(finish(parts, spotAbove({0, 2.5f, 0}, {0, 0.5f, 0}, 12.0f)));
    scene::Light sun;
    sun.type = scene::LightType::Directional;
    check(finish(parts, sun));
}

TEST_F(Extremes, OpenMesh) {
    check(changed(sphere(), [](scene::Geometry& geometry) { geometry.objects[0].indexCount /= 6, geometry.objects[0].indexCount *= 3; }));
}

TEST_F(Extremes, InvertedMesh) {
    check(changed(sphere(), [](scene::Geometry& geometry) {
        const scene::Object& caster = geometry.objects[0];
        for (std::uint32_t i = 0; i < caster.indexCount; i += 3) std::swap(geometry.indices[i], geometry.indices[i + 1]);
        for (std::uint32_t i = 0; i < caster.indexCount; ++i) geometry.vertices[geometry.indices[i]].normal *= -1.0f;
    }));
}

TEST_F(Extremes, TrianglesWithoutAreaOrNormals) {
    check(changed(sphere(), [](scene::Geometry& geometry) {
        const scene::Object& caster = geometry.objects[0];
        for (std::uint32_t i = 0; i < caster.indexCount; i += 30) geometry.indices[i + 1] = geometry.indices[i];
        for (std::uint32_t i = 0; i < caster.indexCount; i += 7) geometry.vertices[geometry.indices[i]].normal = glm::vec3(0.0f);
    }));
}

TEST_F(Extremes, GrazingLight) {
    scene::Scene scene = sphere();
    scene.lights.front() = spotAbove({-3, 0.55f, 0}, {0, 0.5f, 0}, 10.0f);
    check(scene);
}

TEST_F(Extremes, FlatCaster) {   // a single sheet: what enters never leaves
    tests::SyntheticScene parts;
    parts.addQuad(parts.material(glassOf(optics::Cauchy{})), {-0.3f, 0.5f, 0.3f}, {0.6f, 0, 0}, {0, 0, -0.6f});
    addFloor(parts);
    check(finish(parts, spotAbove({0, 2, 0}, {0, 0, 0}, 20.0f)));
}

}  // namespace
}  // namespace caustream::image
