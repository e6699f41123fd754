// What exact surfaces find hard: casters in, on and through one another, light exactly at edges and corners, paths of
// many reflections, more triangles than fit a cache.
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "bench/stability/case.h"
#include "bench/stability/scene_parts.h"

namespace caustream::stability {

namespace {

using render::EnergyLedger;
using tests::SyntheticScene;

const optics::Cauchy kGlass{1.5046, 0.0042};

Setup plain(scene::Scene scene) { return {.scene = std::move(scene), .transport = smallTransport(), .expect = {}, .expectTraced = {}}; }

Setup with(const std::function<void(SyntheticScene&, int glass)>& build, const scene::Light& light = spotAbove({0.2f, 2.5f, 0.1f}, {0, 0.5f, 0}, 14.0f)) {
    SyntheticScene parts;
    build(parts, parts.material(glassOf(kGlass)));
    addFloor(parts);
    return plain(finish(parts, light));
}

scene::Light sunDown() {
    scene::Light light;
    light.name = "sun";
    light.type = scene::LightType::Directional;
    light.direction = {0, -1, 0};
    return light;
}

int water(SyntheticScene& parts, int priority) {
    scene::Material material = glassOf(optics::ConstantIndex{1.333});
    material.priority = priority;
    return parts.material(material);
}

int absorber(SyntheticScene& parts) {
    scene::Material material = glassOf(kGlass);
    material.absorption = {{550.0}, {1e6}};
    return parts.material(material);
}

// Eight faces, a corner straight up.
void addOctahedron(SyntheticScene& parts, int material, const glm::vec3& middle, float radius) {
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 8; ++i) {
        const glm::vec3 x((i & 1) ? -radius : radius, 0, 0), y(0, (i & 2) ? -radius : radius, 0), z(0, 0, (i & 4) ? -radius : radius);
        const bool turned = ((i & 1) != 0) != (((i & 2) != 0) != ((i & 4) != 0));
        corners.insert(corners.end(), {middle + x, middle + (turned ? z : y), middle + (turned ? y : z)});
    }
    parts.addFlat(material, corners);
}

// A box whose top is cut into strips as thin as `share` of it.
void addSlivers(SyntheticScene& parts, int material, float share) {
    const glm::vec3 a(-0.3f, 0.6f, 0.3f), b(0.3f, 0.6f, 0.3f), c(0.3f, 0.6f, -0.3f), d(-0.3f, 0.6f, -0.3f);
    const glm::vec3 e = glm::mix(a, b, share), f = glm::mix(d, c, share), g = glm::mix(a, b, 1.0f - share), h = glm::mix(d, c, 1.0f - share);
    const glm::vec3 down(0, -0.2f, 0);
    std::vector<glm::vec3> corners = {a, e, d, e, f, d, e, g, f, g, h, f, g, b, h, b, c, h};
    const auto quad = [&](const glm::vec3& p, const glm::vec3& q, const glm::vec3& r, const glm::vec3& s) { corners.insert(corners.end(), {p, q, r, p, r, s}); };
    quad(a + down, d + down, c + down, b + down);
    quad(a + down, b + down, b, a), quad(b + down, c + down, c, b), quad(c + down, d + down, d, c), quad(d + down, a + down, a, d);
    parts.addFlat(material, corners);
}

// A cube with every side in n x n squares: coplanar neighbours all over.
void addTiledCube(SyntheticScene& parts, int material, const glm::vec3& middle, float half, int n) {
    std::vector<glm::vec3> corners;
    for (int side = 0; side < 6; ++side) {
        const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        const float sign = (side & 1) ? 1.0f : -1.0f;
        const auto at = [&](int i, int j) {
            glm::vec3 p;
            p[axis] = sign * half;
            p[u] = half * (2.0f * float(i) / float(n) - 1.0f) * sign;
            p[v] = half * (2.0f * float(j) / float(n) - 1.0f);
            return middle + p;
        };
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) corners.insert(corners.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    parts.addFlat(material, corners);
}

// A square rod of glass along x, lit at 45 degrees through its end: 28 degrees to its axis inside, far beyond the critical
// angle at its sides, so that 2 m of it are 20 to 23 total reflections and nothing leaves before the other end.
Setup rod(int bounces) {
    Setup setup = with([](SyntheticScene& parts, int) {
        parts.addBox(parts.material(glassOf(optics::ConstantIndex{1.5})), {-1, 0.5f, -0.025f}, {1, 0.55f, 0.025f});
        parts.addQuad(parts.material(white()), {1.5f, -1, 2}, {0, 0, -4}, {0, 4, 0});
    }, spotAbove({-1.1f, 0.625f, 0}, {-1, 0.525f, 0}, 3.0f));
    setup.transport.bounces = bounces;
    return setup;
}

double gone(const EnergyLedger& l) { return l.deposited + l.leftMap + l.noReceiver; }

std::string passesTheRod(const EnergyLedger& l) { return gone(l) > 0.8 * l.onCasters && l.cut < 0.08 * l.onCasters ? "" : "total reflection loses light"; }
std::string staysInTheRod(const EnergyLedger& l) { return gone(l) <= 1e-3 * l.onCasters ? "" : "light leaves the rod before its end"; }
std::string nothingLeaves(const EnergyLedger& l) { return gone(l) <= 1e-3 * l.onCasters ? "" : "light leaves what is closed and black"; }

void addNested(std::vector<Case>& cases) {
    const auto add = [&](std::string name, std::function<Setup()> make) { cases.push_back({.group = "nested", .name = "nested-" + std::move(name), .make = std::move(make)}); };
    for (const int priority : {-1, 0, 1}) {   // of the water: 0 ties, and the glass comes first
        add("water-priority-" + std::to_string(priority), [=] {
            return with([=](SyntheticScene& parts, int glass) {
                parts.addSphere(glass, {0, 0.5f, 0}, 0.3f);
                parts.addSphere(water(parts, priority), {0.05f, 0.5f, 0}, 0.2f);
            });
        });
    }
    add("five-shells", [] {   // one more than a path remembers to be in
        return with([](SyntheticScene& parts, int) {
            for (int i = 0; i < 5; ++i) parts.addSphere(water(parts, i), {0, 0.5f, 0}, 0.3f - 0.05f * float(i), 24);
        });
    });
    add("boxes", [] {
        return with([](SyntheticScene& parts, int glass) {
            parts.addBox(glass, {-0.3f, 0.3f, -0.3f}, {0.3f, 0.7f, 0.3f});
            parts.addBox(water(parts, 1), {-0.1f, 0.4f, -0.1f}, {0.1f, 0.6f, 0.1f});
        });
    });
    add("boxes-with-a-common-face", [] {   // the inner one's top lies in the outer one's
        return with([](SyntheticScene& parts, int glass) {
            parts.addBox(glass, {-0.3f, 0.3f, -0.3f}, {0.3f, 0.7f, 0.3f});
            parts.addBox(water(parts, 1), {-0.1f, 0.4f, -0.1f}, {0.1f, 0.7f, 0.1f});
        });
    });
    add("twins", [] {   // two casters that are one and the same
        return with([](SyntheticScene& parts, int glass) {
            parts.addBox(glass, {-0.3f, 0.3f, -0.3f}, {0.3f, 0.7f, 0.3f});
            parts.addBox(water(parts, 1), {-0.3f, 0.3f, -0.3f}, {0.3f, 0.7f, 0.3f});
        });
    });
    add("meshes-through-each-other", [] {
        return with([](SyntheticScene& parts, int glass) {
            parts.addSphere(glass, {-0.1f, 0.5f, 0}, 0.2f);
            parts.addSphere(water(parts, 1), {0.1f, 0.5f, 0}, 0.2f);
        });
    });
    add("boxes-that-touch", [] {   // 0.5 mm of nothing between them is none
        return with([](SyntheticScene& parts, int glass) {
            parts.addBox(glass, {-0.3f, 0.5f, -0.3f}, {0.3f, 0.7f, 0.3f});
            parts.addBox(water(parts, 1), {-0.3f, 0.3f, -0.3f}, {0.3f, 0.5f, 0.3f});
        });
    });
    add("boxes-almost-touch", [] {
        return with([](SyntheticScene& parts, int glass) {
            parts.addBox(glass, {-0.3f, 0.500001f, -0.3f}, {0.3f, 0.7f, 0.3f});
            parts.addBox(water(parts, 1), {-0.3f, 0.3f, -0.3f}, {0.3f, 0.5f, 0.3f});
        });
    });
    add("spheres-that-touch", [] {
        return with([](SyntheticScene& parts, int glass) {
            parts.addSphere(glass, {0, 0.8f, 0}, 0.2f);
            parts.addSphere(water(parts, 1), {0, 0.4f, 0}, 0.2f);
        }, sunDown());
    });
    add("stands-on-the-floor", [] { return with([](SyntheticScene& parts, int glass) { parts.addBox(glass, {-0.3f, 0, -0.3f}, {0.3f, 0.4f, 0.3f}); }); });
    add("through-the-floor", [] { return with([](SyntheticScene& parts, int glass) { parts.addSphere(glass, {0, 0.1f, 0}, 0.3f); }); });
    add("through-the-floor-exact", [] {
        Setup setup = with([](SyntheticScene& parts, int glass) { parts.addSphere(glass, {0, 0.1f, 0}, 0.3f); });
        setup.transport.exactReceivers = true;
        return setup;
    });
}

void addAimed(std::vector<Case>& cases) {
    const auto add = [&](std::string name, std::function<Setup()> make) { cases.push_back({.group = "aimed", .name = "aimed-" + std::move(name), .make = std::move(make)}); };
    const auto octahedron = [](SyntheticScene& parts, int glass) { addOctahedron(parts, glass, {0, 0.5f, 0}, 0.3f); };
    add("at-a-corner", [=] { return with(octahedron, spotAbove({0, 2.5f, 0}, {0, 0.5f, 0}, 12.0f)); });
    add("at-a-corner-narrow", [=] {
        Setup setup = with(octahedron, spotAbove({0, 2.5f, 0}, {0, 0.5f, 0}, 1e-3f));
        setup.jumps = "the step is as wide as the cone";
        return setup;
    });
    add("at-a-corner-sun", [=] { return with(octahedron, sunDown()); });
    add("at-an-edge", [=] { return with(octahedron, spotAbove({0.15f, 2.5f, 0}, {0.15f, 0.65f, 0}, 0.01f)); });
    add("at-a-corner-of-an-absorber", [] {
        Setup setup = with([](SyntheticScene& parts, int) { addOctahedron(parts, absorber(parts), {0, 0.5f, 0}, 0.3f); }, spotAbove({0, 2.5f, 0}, {0, 0.5f, 0}, 12.0f));
        setup.expect = nothingLeaves;
        return setup;
    });
    add("along-a-face", [] {   // the cube's sides are edge-on
        return with([](SyntheticScene& parts, int glass) { parts.addBox(glass, {-0.2f, 0.3f, -0.2f}, {0.2f, 0.7f, 0.2f}); }, sunDown());
    });
    add("in-the-plane-of-a-face", [] {
        return with([](SyntheticScene& parts, int glass) { parts.addBox(glass, {-0.2f, 0.3f, -0.2f}, {0.2f, 0.7f, 0.2f}); }, spotAbove({0.2f, 2.5f, 0}, {0, 0.5f, 0}, 14.0f));
    });
    add("along-the-diagonal", [] {   // photons of a regular grid fall on the edges between coplanar tiles
        return with([](SyntheticScene& parts, int glass) { addTiledCube(parts, glass, {0, 0.5f, 0}, 0.2f, 8); }, sunDown());
    });
    add("from-a-corner", [] {
        Setup setup = with([](SyntheticScene& parts, int glass) { parts.addBox(glass, {-0.2f, 0.3f, -0.2f}, {0.2f, 0.7f, 0.2f}); }, spotAbove({0.2f, 0.7f, 0.2f}, {0, 0.3f, 0}, 40.0f));
        setup.jumps = "the step leads out of the glass";
        return setup;
    });
    add("from-a-face", [] {
        return with([](SyntheticScene& parts, int glass) { parts.addBox(glass, {-0.2f, 0.3f, -0.2f}, {0.2f, 0.7f, 0.2f}); }, spotAbove({0, 0.7f, 0}, {0, 0.3f, 0}, 60.0f));
    });
    for (const float share : {0.1f, 1e-3f, 1e-5f, 1e-7f}) {
        add(numbered("slivers", share), [=] { return with([=](SyntheticScene& parts, int glass) { addSlivers(parts, glass, share); }); });
    }
    add("tiles", [] { return with([](SyntheticScene& parts, int glass) { addTiledCube(parts, glass, {0, 0.5f, 0}, 0.2f, 16); }); });
    add("box-without-a-side", [] {
        return with([](SyntheticScene& parts, int glass) {
            parts.addBox(glass, {-0.2f, 0.3f, -0.2f}, {0.2f, 0.7f, 0.2f});
            parts.edit().objects.back().indexCount -= 6;
        });
    });
    add("box-without-a-top", [] {
        return with([](SyntheticScene& parts, int glass) {
            parts.addBox(glass, {-0.2f, 0.3f, -0.2f}, {0.2f, 0.7f, 0.2f});
            scene::Geometry& geometry = parts.edit();
            const auto top = geometry.indices.begin() + geometry.objects.back().firstIndex + 18;   // sides: -x, +x, -y, +y
            geometry.indices.erase(top, top + 6);
            geometry.objects.back().indexCount -= 6;
        });
    });
}

void addBounces(std::vector<Case>& cases) {
    const auto add = [&](std::string name, std::function<Setup()> make) { cases.push_back({.group = "bounces", .name = "bounces-" + std::move(name), .make = std::move(make)}); };
    add("rod-32", [] {
        Setup setup = rod(32);
        setup.expectTraced = passesTheRod;
        return setup;
    });
    for (const int bounces : {0, 1, 8}) {
        add("rod-" + std::to_string(bounces), [=] {
            Setup setup = rod(bounces);
            setup.expectTraced = staysInTheRod;
            return setup;
        });
    }
    for (const int bounces : {0, 1, 32}) {
        add("diamond-" + std::to_string(bounces), [=] {
            Setup setup = with([](SyntheticScene& parts, int) { addOctahedron(parts, parts.material(glassOf(optics::ConstantIndex{2.42})), {0, 0.5f, 0}, 0.3f); });
            setup.transport.bounces = bounces;
            return setup;
        });
        add("mesh-" + std::to_string(bounces), [=] {
            Setup setup = plain(sphereScene(optics::ConstantIndex{2.42}));
            setup.transport.bounces = bounces;
            return setup;
        });
    }
    add("exact-receivers", [] {
        Setup setup = plain(sphereScene(kGlass));
        setup.transport.exactReceivers = true;
        return setup;
    });
    cases.push_back({.group = kLargeGroup, .name = "triangles-1e6", .make = [] {
                         return with([](SyntheticScene& parts, int glass) { parts.addSphere(glass, {0, 0.5f, 0}, 0.3f, 500); });
                     }});
}

}  // namespace

std::vector<Case> tracedCases() {
    std::vector<Case> cases;
    addNested(cases), addAimed(cases), addBounces(cases);
    return cases;
}

}  // namespace caustream::stability
