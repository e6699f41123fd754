// What the light falls on, and how large the whole scene is and where.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "bench/stability/case.h"
#include "bench/stability/scene_parts.h"

namespace caustream::stability {

namespace {

using tests::SyntheticScene;

Setup plain(scene::Scene scene) { return {.scene = std::move(scene), .transport = smallTransport(), .expect = {}}; }

// The glass sphere of radius 0.3 at height 0.5 under a spot, over what `build` adds.
Setup over(const std::function<void(SyntheticScene&)>& build, const glm::vec3& light = {0.5f, 2.5f, 0.3f}) {
    SyntheticScene parts;
    parts.addSphere(parts.material(glassOf(optics::Cauchy{1.5046, 0.0042})), {0, 0.5f, 0}, 0.3f);
    build(parts);
    return plain(finish(parts, spotAbove(light, {0, 0.5f, 0}, 12.0f)));
}

void addFloorAt(SyntheticScene& parts, float y, float half) {
    parts.addQuad(parts.material(white()), {-half, y, half}, {2 * half, 0, 0}, {0, 0, -2 * half});
}

std::string nothingLands(const render::EnergyLedger& ledger) { return ledger.deposited == 0.0 ? "" : "light lands where nothing is"; }
std::string nothingStarts(const render::EnergyLedger& ledger) { return ledger.onCasters == 0.0 ? "" : "light meets a caster that is not there"; }

Setup scaledSphere(float by) {
    Setup setup = plain(scaled(sphereScene(optics::Cauchy{1.5046, 0.0042}), by));
    // What it is at 1 m, whatever the size; rounding differs, and with it what happens at the rim.
    setup.expectRefined = [](const render::EnergyLedger& ledger) {
        const double share = ledger.deposited / ledger.onCasters;
        return std::abs(share - 0.8258) < 1e-3 ? "" : "the share that lands depends on the scale: " + std::to_string(share);
    };
    return setup;
}

}  // namespace

std::vector<Case> receiverCases() {
    std::vector<Case> cases;
    const auto in = [&](const char* group, std::string name, std::function<Setup()> make) {
        cases.push_back({.group = group, .name = std::move(name), .make = std::move(make)});
    };
    const auto add = [&](std::string name, std::function<Setup()> make) { in("receiver", std::move(name), std::move(make)); };

    add("none", [] {
        Setup setup = over([](SyntheticScene&) {});
        setup.expect = nothingLands;
        return setup;
    });
    add("no-caster", [] {
        SyntheticScene parts;
        addFloor(parts);
        Setup setup = plain(finish(parts, spotAbove({0, 2, 0}, {0, 0, 0}, 20.0f)));
        setup.expect = nothingStarts;
        return setup;
    });
    add("edge-on", [] { return over([](SyntheticScene& parts) { parts.addQuad(parts.material(white()), {0, -5, -5}, {0, 10, 0}, {0, 0, 10}); }, {0, 2.5f, 0}); });
    add("edge-on-to-the-sun", [] {
        Setup setup = over([](SyntheticScene& parts) { parts.addQuad(parts.material(white()), {0.1f, -5, -5}, {0, 10, 0}, {0, 0, 10}); });
        setup.scene.lights.front().type = scene::LightType::Directional;
        setup.scene.lights.front().direction = {0, -1, 0};
        setup.jumps = "the wall is edge-on to the light: it is a line in the map";
        return setup;
    });
    add("behind-the-light", [] { return over([](SyntheticScene& parts) { addFloorAt(parts, 3.0f, 5.0f); }); });
    add("before-the-caster", [] { return over([](SyntheticScene& parts) { addFloorAt(parts, 0.0f, 5.0f), addFloorAt(parts, 1.5f, 0.3f); }); });
    add("touches-the-caster", [] { return over([](SyntheticScene& parts) { addFloorAt(parts, 0.2f, 5.0f); }); });
    add("through-the-caster", [] { return over([](SyntheticScene& parts) { addFloorAt(parts, 0.5f, 5.0f); }); });
    add("in-the-focus", [] { return over([](SyntheticScene& parts) { addFloorAt(parts, 0.08f, 5.0f); }); });
    add("of-one-texel", [] { return over([](SyntheticScene& parts) { addFloorAt(parts, 0.0f, 1e-3f); }); });
    add("far-below", [] { return over([](SyntheticScene& parts) { addFloorAt(parts, -1e3f, 5e3f); }); });
    add("near-and-far", [] { return over([](SyntheticScene& parts) { addFloorAt(parts, 0.199f, 0.05f), addFloorAt(parts, -1e4f, 1e5f); }); });   // 1 mm to 10 km
    add("stairs", [] {
        return over([](SyntheticScene& parts) {
            for (int i = 0; i < 16; ++i) parts.addBox(parts.material(white()), {-2 + 0.25f * float(i), -1, -2}, {-1.75f + 0.25f * float(i), -0.05f * float(i % 5), 2});
        });
    });
    add("corner", [] {
        return over([](SyntheticScene& parts) {
            addFloor(parts);
            parts.addQuad(parts.material(white()), {-0.4f, 0, -5}, {0, 0, 10}, {0, 5, 0});
        });
    });
    add("mirror", [] {
        return over([](SyntheticScene& parts) {
            scene::Material metal;
            metal.metallic = 1.0f, metal.roughness = 0.0f;
            parts.addQuad(parts.material(metal), {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
        });
    });
    add("glowing", [] {
        return over([](SyntheticScene& parts) {
            scene::Material lamp;
            lamp.emissive = glm::vec3(1e5f);
            parts.addQuad(parts.material(lamp), {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
        });
    });
    add("black", [] {
        return over([](SyntheticScene& parts) {
            scene::Material black;
            black.baseColor = {0, 0, 0, 1};
            parts.addQuad(parts.material(black), {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
        });
    });
    add("without-area", [] { return over([](SyntheticScene& parts) { addFloorAt(parts, 0.0f, 0.0f); }); });

    // Scale and place: the same scene, all of it
    for (const float by : {1e-6f, 1e-3f, 1e-2f, 1e2f, 1e4f, 1e6f, 1e9f, 1e12f}) in("scale", numbered("scaled", by), [=] { return scaledSphere(by); });
    for (const float by : {1e2f, 1e4f, 1e6f}) {
        in("scale", numbered("far-from-origin", by), [=] { return plain(shifted(sphereScene(optics::Cauchy{1.5046, 0.0042}), glm::vec3(by, 0, -by))); });
    }
    in("scale", "near-far-1e6", [] {   // seen and lit from 1 mm to 1 km
        Setup setup = over([](SyntheticScene& parts) { addFloorAt(parts, 0.0f, 1e3f); }, {0, 0.801f, 0});
        setup.scene.cameras.front().eye = {0, 0.002f, 0.6f};
        setup.scene.cameras.front().target = {0, 0, -100.0f};
        return setup;
    });
    return cases;
}

}  // namespace caustream::stability
