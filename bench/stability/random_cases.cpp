// Scenes that a seed draws: any glass, mesh, light, receiver and option at once.
#include <algorithm>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "bench/stability/case.h"
#include "bench/stability/random.h"
#include "bench/stability/scene_parts.h"

namespace caustream::stability {

namespace {

using tests::SyntheticScene;

scene::Material drawGlass(Random& random) {
    scene::Material glass;
    glass.caster = true;
    switch (random.upTo(3)) {
        case 0: glass.dispersion = optics::Cauchy{random.uniform(1.0003, 3.0), random.logarithmic(1e-4, 0.6)}; break;
        case 1: glass.dispersion = optics::Abbe{random.uniform(1.1, 2.5), random.logarithmic(2.0, 90.0)}; break;
        case 2: glass.dispersion = optics::ConstantIndex{random.uniform(1.01, 4.0)}; break;
        default: glass.dispersion = optics::kGlassPresets[static_cast<std::size_t>(random.upTo(7))].dispersion;
    }
    if (random.oneIn(3)) glass.absorption = {{380.0, 500.0, 680.0}, {random.logarithmic(1e-3, 1e3), random.logarithmic(1e-3, 1e3), random.logarithmic(1e-3, 1e3)}};
    glass.thinWalled = random.oneIn(8);
    return glass;
}

// The last object of `parts`: bent, stretched, turned, moved, and perhaps broken.
void deform(SyntheticScene& parts, Random& random, const glm::vec3& middle) {
    scene::Geometry& geometry = parts.edit();
    const scene::Object& object = geometry.objects.back();
    const glm::vec3 stretch(random.uniform(0.3, 1.6), random.uniform(0.3, 1.6), random.uniform(0.3, 1.6));
    const glm::mat3 turn(glm::rotate(glm::mat4(1.0f), float(random.uniform(0.0, 6.3)), random.direction()));
    const glm::vec3 wave = random.oneIn(2) ? float(random.uniform(2.0, 20.0)) * random.direction() : glm::vec3(0.0f);
    const float depth = float(random.uniform(0.0, 0.2));
    const bool flat = random.oneIn(3);
    for (std::uint32_t i = 0; i < object.indexCount; ++i) {
        scene::Vertex& vertex = geometry.vertices[geometry.indices[object.firstIndex + i]];
        vertex.position = middle + turn * (stretch * vertex.position * (1.0f + depth * std::sin(glm::dot(wave, vertex.position))));
        vertex.normal = glm::normalize(turn * (vertex.normal / stretch));
    }
    const int damage = random.upTo(9), pitch = 3 * (2 + random.upTo(40));
    for (std::uint32_t i = 0; i + 2 < object.indexCount; i += 3) {
        scene::Vertex* v[3];
        for (std::uint32_t k = 0; k < 3; ++k) v[k] = &geometry.vertices[geometry.indices[object.firstIndex + i + k]];
        if (i % static_cast<std::uint32_t>(pitch) == 0) {
            if (damage == 0) v[1]->position = v[0]->position;                       // no area
            if (damage == 1) std::swap(*v[0], *v[1]);                               // inverted
            if (damage == 2) v[2]->normal = glm::vec3(0.0f);                        // no normal
            if (damage == 3) v[0]->position = v[1]->position = v[2]->position = middle;   // a hole
        }
        const glm::vec3 cross = glm::cross(v[1]->position - v[0]->position, v[2]->position - v[0]->position);
        if (flat && glm::length(cross) > 0.0f) v[0]->normal = v[1]->normal = v[2]->normal = glm::normalize(cross);
    }
}

void addCaster(SyntheticScene& parts, Random& random, const glm::vec3& middle, float radius) {
    const int material = parts.material(drawGlass(random));
    switch (random.upTo(2)) {
        case 0: parts.addSphere(material, glm::vec3(0.0f), radius, 4 + random.upTo(28)); break;
        case 1: parts.addBox(material, glm::vec3(-radius), glm::vec3(radius)); break;
        default: {   // loose triangles
            std::vector<glm::vec3> corners;
            for (int i = 0; i < 3 * (4 + random.upTo(20)); ++i) corners.push_back(radius * random.direction());
            parts.addFlat(material, corners);
        }
    }
    deform(parts, random, middle);
}

void addReceivers(SyntheticScene& parts, Random& random) {
    scene::Material surface;
    surface.roughness = float(random.uniform()), surface.metallic = random.oneIn(4) ? 1.0f : 0.0f;
    if (!random.oneIn(12)) parts.addQuad(parts.material(surface), {-5, 0, 5}, {10, float(random.uniform(-1.0, 1.0)), 0}, {0, 0, -10});
    if (random.oneIn(2)) parts.addQuad(parts.material(white()), {-2, -1, -5}, {0, 0, 10}, {float(random.uniform(-0.5, 0.5)), 5, 0});
    for (int i = random.upTo(3); i > 0; --i) {
        const glm::vec3 at = 1.5f * random.direction(), half(random.uniform(0.02, 0.5), random.uniform(0.02, 0.5), random.uniform(0.02, 0.5));
        parts.addBox(parts.material(white()), at - half, at + half);
    }
}

scene::Light drawLight(Random& random) {
    const glm::vec3 from = random.direction();
    const glm::vec3 position = glm::vec3(0, 0.6f, 0) + float(random.logarithmic(0.2, 20.0)) * glm::vec3(from.x, std::abs(from.y), from.z);
    scene::Light light = spotAbove(position, glm::vec3(0, 0.6f, 0) + 0.2f * random.direction(), float(random.logarithmic(0.5, 85.0)));
    light.innerConeDeg = random.oneIn(2) ? light.outerConeDeg : light.outerConeDeg * float(random.uniform());
    light.type = random.oneIn(5) ? scene::LightType::Directional : random.oneIn(5) ? scene::LightType::Point : scene::LightType::Spot;
    light.intensity = float(random.logarithmic(1e-3, 1e6));
    if (random.oneIn(4)) light.spectrum = optics::Blackbody{random.logarithmic(800.0, 2e4)};
    if (random.oneIn(6)) light.cookie = 0;
    return light;
}

Setup draw(std::uint64_t seed) {
    Random random(seed);
    SyntheticScene parts;
    for (int i = random.upTo(2); i >= 0; --i) {
        addCaster(parts, random, glm::vec3(0, 0.6f, 0) + float(random.uniform(0.0, 0.6)) * random.direction(), float(random.logarithmic(0.02, 0.5)));
    }
    addReceivers(parts, random);
    scene::Texture cookie{8, 8, {}};
    for (int i = 0; i < 8 * 8 * 4; ++i) cookie.rgba.push_back(static_cast<std::uint8_t>(random.upTo(255)));
    parts.edit().textures.push_back(cookie);

    Setup setup{.scene = finish(parts, drawLight(random)), .transport = smallTransport(), .expect = {}};
    setup.scene.outsideIndex = random.oneIn(4) ? random.uniform(1.0, 2.0) : random.oneIn(2) ? 1.0003 : 1.0;
    setup.scene.cameras.front().eye = glm::vec3(0, 0.5f, 0) + float(random.logarithmic(0.3, 6.0)) * random.direction();
    setup.scene.cameras.front().fovYDeg = float(random.uniform(10.0, 120.0));
    setup.transport.photonGrid = 16 + random.upTo(112);
    setup.transport.mapSize = 64 + 16 * random.upTo(6);
    setup.transport.backSteps = random.oneIn(2) ? 4 : 1 + random.upTo(15);
    setup.transport.receiverSteps = random.oneIn(2) ? 6 : 1 + random.upTo(31);
    setup.transport.filter = !random.oneIn(4);
    setup.transport.gapFill = random.oneIn(6);
    if (random.oneIn(4)) setup.scene = scaled(std::move(setup.scene), float(random.logarithmic(1e-3, 1e4)));
    return setup;
}

}  // namespace

Case randomCase(std::uint64_t seed) {
    return {.group = "random", .name = "seed-" + std::to_string(seed), .seed = seed, .make = [seed] { return draw(seed); }};
}

std::string numbered(const char* what, double value) {
    char text[64];
    std::snprintf(text, sizeof text, "%s-%g", what, value);
    return text;
}

render::Transport smallTransport() {
    render::Transport transport;
    transport.photonGrid = 96;
    transport.mapSize = 128;
    return transport;
}

std::vector<Case> allCases(int random) {
    std::vector<Case> cases;
    for (const auto& group : {glassCases, lightCases, casterCases, tracedCases, mirrorCases, receiverCases, optionCases, builtinCases}) {
        for (Case& one : group()) cases.push_back(std::move(one));
    }
    for (int seed = 1; seed <= random; ++seed) cases.push_back(randomCase(static_cast<std::uint64_t>(seed)));
    return cases;
}

}  // namespace caustream::stability
