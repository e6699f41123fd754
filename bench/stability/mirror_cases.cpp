// Casters that reflect: alone, facing each other, around the light, in and on glass.
#include <cmath>
#include <utility>

#include "bench/stability/case.h"
#include "bench/stability/scene_parts.h"

namespace caustream::stability {

namespace {

using render::EnergyLedger;
using tests::SyntheticScene;

int mirror(SyntheticScene& parts, const glm::vec3& colour = glm::vec3(0.9f)) {
    scene::Material material;
    material.mirror = true;
    material.metallic = 1.0f, material.roughness = 0.0f;
    material.baseColor = glm::vec4(colour, 1.0f);
    return parts.material(material);
}

Setup with(const std::function<void(SyntheticScene&, int metal)>& build, const scene::Light& light = spotAbove({0.2f, 2.5f, 0.1f}, {0, 0.5f, 0}, 14.0f)) {
    SyntheticScene parts;
    build(parts, mirror(parts));
    addFloor(parts);
    return {.scene = finish(parts, light), .transport = smallTransport(), .expect = {}, .expectTraced = {}};
}

double gone(const EnergyLedger& l) { return l.deposited + l.leftMap + l.noReceiver; }

std::string nothingLeaves(const EnergyLedger& l) { return gone(l) <= 1e-3 * l.onCasters ? "" : "light leaves a closed mirror"; }
std::string nothingBehind(const EnergyLedger& l) { return l.deposited <= 1e-3 * l.onCasters ? "" : "light lands behind a mirror"; }

}  // namespace

std::vector<Case> mirrorCases() {
    std::vector<Case> cases;
    const auto add = [&](std::string name, std::function<Setup()> make) { cases.push_back({.group = "mirror", .name = "mirror-" + std::move(name), .make = std::move(make)}); };
    const optics::Cauchy glass{1.5046, 0.0042};

    add("ball", [] { return with([](SyntheticScene& parts, int metal) { parts.addSphere(metal, {0, 0.5f, 0}, 0.3f); }); });
    add("cube", [] { return with([](SyntheticScene& parts, int metal) { parts.addBox(metal, {-0.2f, 0.3f, -0.2f}, {0.2f, 0.7f, 0.2f}); }); });
    add("on-the-floor", [] { return with([](SyntheticScene& parts, int metal) { parts.addBox(metal, {-0.2f, 0, -0.2f}, {0.2f, 0.4f, 0.2f}); }); });
    add("upright", [] {   // throws light at the floor before it
        return with([](SyntheticScene& parts, int metal) { parts.addQuad(metal, {-0.5f, 0.1f, 0}, {1, 0, 0}, {0, 1, 0}); }, spotAbove({0, 2, 2}, {0, 0.6f, 0}, 15.0f));
    });
    add("seen-from-behind", [] {
        return with([](SyntheticScene& parts, int metal) { parts.addQuad(metal, {0.5f, 0.1f, 0}, {-1, 0, 0}, {0, 1, 0}); }, spotAbove({0, 2, 2}, {0, 0.6f, 0}, 15.0f));
    });
    add("lid", [] {   // throws all light up: none can land below
        Setup setup = with([](SyntheticScene& parts, int metal) { parts.addQuad(metal, {-2, 0.5f, 2}, {4, 0, 0}, {0, 0, -4}); });
        setup.expectTraced = nothingBehind;
        return setup;
    });
    add("black", [] {
        Setup setup = with([](SyntheticScene& parts, int) { parts.addSphere(mirror(parts, glm::vec3(0.0f)), {0, 0.5f, 0}, 0.3f); });
        return setup;
    });
    add("edge-on", [] {
        Setup setup = with([](SyntheticScene& parts, int metal) { parts.addQuad(metal, {0, 0.2f, 0.3f}, {0, 0.6f, 0}, {0, 0, -0.6f}); }, spotAbove({0, 2.5f, 0}, {0, 0.5f, 0}, 14.0f));
        setup.jumps = "the mirror is edge-on to the light: a step lights all of it";
        return setup;
    });
    add("facing-each-other", [] {
        return with([](SyntheticScene& parts, int metal) {
            parts.addQuad(metal, {-0.2f, 0.2f, 1}, {0, 0, -2}, {0, 1, 0});
            parts.addQuad(metal, {0.2f, 0.2f, -1}, {0, 0, 2}, {0, 1, 0});
        }, spotAbove({0, 2.2f, 0}, {0.1f, 0.9f, 0}, 6.0f));
    });
    for (const int bounces : {0, 8, 32}) {
        add("room-" + std::to_string(bounces), [=] {   // the light in a closed box of mirrors, the floor outside
            Setup setup = with([](SyntheticScene& parts, int metal) {
                std::vector<scene::Vertex>& vertices = parts.edit().vertices;
                parts.addBox(metal, {-0.3f, 0.3f, -0.3f}, {0.3f, 0.9f, 0.3f});
                for (scene::Vertex& vertex : vertices) vertex.normal *= -1.0f;
                std::vector<std::uint32_t>& indices = parts.edit().indices;
                for (std::size_t i = 0; i + 2 < indices.size(); i += 3) std::swap(indices[i], indices[i + 1]);
            }, spotAbove({0.02f, 0.7f, 0.01f}, {0, 0.3f, 0}, 50.0f));
            setup.transport.bounces = bounces;
            setup.expectTraced = nothingLeaves;
            return setup;
        });
    }
    add("in-glass", [=] {
        return with([=](SyntheticScene& parts, int metal) {
            parts.addSphere(parts.material(glassOf(glass)), {0, 0.5f, 0}, 0.3f);
            parts.addSphere(metal, {0, 0.5f, 0}, 0.1f);
        });
    });
    add("under-glass", [=] {   // a face in common
        return with([=](SyntheticScene& parts, int metal) {
            parts.addBox(parts.material(glassOf(glass)), {-0.2f, 0.5f, -0.2f}, {0.2f, 0.7f, 0.2f});
            parts.addBox(metal, {-0.2f, 0.3f, -0.2f}, {0.2f, 0.5f, 0.2f});
        });
    });
    add("through-glass", [=] {
        return with([=](SyntheticScene& parts, int metal) {
            parts.addBox(parts.material(glassOf(glass)), {-0.2f, 0.3f, -0.2f}, {0.2f, 0.7f, 0.2f});
            parts.addQuad(metal, {-0.4f, 0.5f, 0.4f}, {0.8f, 0, 0}, {0, 0, -0.8f});
        });
    });
    add("sun", [] {
        scene::Light sun;
        sun.name = "sun";
        sun.type = scene::LightType::Directional;
        sun.direction = {0, -1, 0};
        return with([](SyntheticScene& parts, int metal) { parts.addSphere(metal, {0, 0.5f, 0}, 0.3f); }, sun);
    });
    return cases;
}

}  // namespace caustream::stability
