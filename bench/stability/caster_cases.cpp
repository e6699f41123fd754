// Shapes of glass: how large, how many, and how broken.
#include <glm/geometric.hpp>
#include <utility>

#include "bench/stability/case.h"
#include "bench/stability/scene_parts.h"

namespace caustream::stability {

namespace {

using tests::SyntheticScene;

const optics::Cauchy kGlass{1.5046, 0.0042};

Setup plain(scene::Scene scene) { return {.scene = std::move(scene), .transport = smallTransport(), .expect = {}}; }

// The sphere's mesh, changed. `change` gets the geometry and the range of its indices.
template <class Change>
Setup broken(Change&& change) {
    return plain(changed(sphereScene(kGlass), [&](scene::Geometry& geometry) { change(geometry, geometry.objects[0]); }));
}

scene::Vertex& corner(scene::Geometry& geometry, std::uint32_t i) { return geometry.vertices[geometry.indices[i]]; }

Setup ofRadius(float radius) {
    return broken([=](scene::Geometry& geometry, const scene::Object& caster) {
        for (std::uint32_t i = 0; i < caster.indexCount; ++i) corner(geometry, i).position = glm::vec3(0, 0.5f, 0) + radius * corner(geometry, i).normal;
    });
}

Setup with(const std::function<void(SyntheticScene&, int glass)>& build, const glm::vec3& light = {0.2f, 2.5f, 0.1f}, float halfAngleDeg = 14.0f) {
    SyntheticScene parts;
    build(parts, parts.material(glassOf(kGlass)));
    addFloor(parts);
    return plain(finish(parts, spotAbove(light, {0, 0.5f, 0}, halfAngleDeg)));
}

void addTriangle(SyntheticScene& parts, int material, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) { parts.addFlat(material, {a, b, c}); }

}  // namespace

std::vector<Case> casterCases() {
    std::vector<Case> cases;
    const auto add = [&](std::string name, std::function<Setup()> make) {
        cases.push_back({.group = "caster", .name = std::move(name), .make = std::move(make)});
    };

    // Size
    add("radius-1e-7", [] { return ofRadius(1e-7f); });
    add("radius-1e-4", [] { return ofRadius(1e-4f); });
    add("radius-1e-2", [] { return ofRadius(1e-2f); });
    add("radius-0", [] { return ofRadius(0.0f); });
    add("fills-both-views", [] {
        Setup setup = plain(sphereScene(kGlass));
        setup.scene.lights.front() = spotAbove({0, 0.85f, 0}, {0, 0, 0}, 20.0f);
        setup.scene.cameras.front().eye = {0, 0.5f, 0.31f};
        setup.scene.cameras.front().target = {0, 0.5f, 0};
        return setup;
    });
    add("camera-inside", [] {
        Setup setup = plain(sphereScene(kGlass));
        setup.scene.cameras.front().eye = {0.05f, 0.5f, 0.1f};
        return setup;
    });
    add("camera-looks-down", [] {
        Setup setup = plain(sphereScene(kGlass));
        setup.scene.cameras.front().eye = {0, 3, 0};
        return setup;
    });

    // Broken meshes
    add("open", [] { return broken([](scene::Geometry&, scene::Object& caster) { caster.indexCount = caster.indexCount / 6 * 3; }); });
    add("inverted", [] {
        return broken([](scene::Geometry& geometry, const scene::Object& caster) {
            for (std::uint32_t i = 0; i < caster.indexCount; i += 3) std::swap(geometry.indices[i], geometry.indices[i + 1]);
            for (std::uint32_t i = 0; i < caster.indexCount; ++i) corner(geometry, i).normal *= -1.0f;
        });
    });
    add("half-inverted", [] {
        return broken([](scene::Geometry& geometry, const scene::Object& caster) {
            for (std::uint32_t i = 0; i < caster.indexCount; i += 6) std::swap(geometry.indices[i], geometry.indices[i + 1]);
        });
    });
    add("zero-area", [] {
        return broken([](scene::Geometry& geometry, const scene::Object& caster) {
            for (std::uint32_t i = 0; i < caster.indexCount; i += 30) geometry.indices[i + 1] = geometry.indices[i];
        });
    });
    add("duplicated", [] {
        return broken([](scene::Geometry& geometry, scene::Object& caster) {   // the first half again, in place of the floor
            const std::vector<std::uint32_t> again(geometry.indices.begin(), geometry.indices.begin() + caster.indexCount);
            geometry.indices.insert(geometry.indices.begin(), again.begin(), again.end());
            geometry.objects[1].firstIndex += caster.indexCount;
            caster.indexCount *= 2;
        });
    });
    add("no-normals", [] {
        return broken([](scene::Geometry& geometry, const scene::Object& caster) {
            for (std::uint32_t i = 0; i < caster.indexCount; ++i) corner(geometry, i).normal = glm::vec3(0.0f);
        });
    });
    add("some-normals", [] {
        return broken([](scene::Geometry& geometry, const scene::Object& caster) {
            for (std::uint32_t i = 0; i < caster.indexCount; i += 7) corner(geometry, i).normal = glm::vec3(0.0f);
        });
    });
    add("wrong-normals", [] {
        return broken([](scene::Geometry& geometry, const scene::Object& caster) {
            for (std::uint32_t i = 0; i < caster.indexCount; ++i) corner(geometry, i).normal = glm::vec3(0, 0, 1);
        });
    });
    add("turned-normals", [] {
        return broken([](scene::Geometry& geometry, const scene::Object& caster) {
            for (std::uint32_t i = 0; i < caster.indexCount; ++i) corner(geometry, i).normal *= -1.0f;
        });
    });
    add("one-point", [] {
        return broken([](scene::Geometry& geometry, const scene::Object& caster) {
            for (std::uint32_t i = 0; i < caster.indexCount; ++i) corner(geometry, i).position = {0, 0.5f, 0};
        });
    });
    add("spikes", [] {
        return broken([](scene::Geometry& geometry, const scene::Object& caster) {
            for (std::uint32_t i = 0; i < caster.indexCount; i += 90) corner(geometry, i).position = glm::vec3(0, 0.5f, 0) + 1.2f * corner(geometry, i).normal;
        });
    });
    add("sheet", [] { return with([](SyntheticScene& parts, int glass) { parts.addQuad(glass, {-0.3f, 0.5f, 0.3f}, {0.6f, 0, 0}, {0, 0, -0.6f}); }); });
    add("sheet-edge-on", [] { return with([](SyntheticScene& parts, int glass) { parts.addQuad(glass, {0, 0.2f, 0.3f}, {0, 0.6f, 0}, {0, 0, -0.6f}); }, {0, 2.5f, 0}); });
    add("one-triangle", [] { return with([](SyntheticScene& parts, int glass) { addTriangle(parts, glass, {-0.3f, 0.5f, 0.3f}, {0.3f, 0.5f, 0.3f}, {0, 0.6f, -0.3f}); }); });
    add("needle", [] { return with([](SyntheticScene& parts, int glass) { parts.addBox(glass, {-1e-5f, 0.2f, -0.4f}, {1e-5f, 0.9f, 0.4f}); }); });
    add("fin-on-edge", [] {   // three triangles at one edge
        return with([](SyntheticScene& parts, int glass) {
            const glm::vec3 a(0, 0.5f, 0.3f), b(0, 0.5f, -0.3f);
            parts.addFlat(glass, {a, b, {0.3f, 0.7f, 0}, b, a, {-0.3f, 0.7f, 0}, a, b, {0, 0.9f, 0}});
        });
    });
    add("touches-itself", [] {
        return with([](SyntheticScene& parts, int glass) {
            parts.addBox(glass, {-0.3f, 0.3f, -0.3f}, {0, 0.6f, 0});
            parts.addBox(glass, {0, 0.6f, 0}, {0.3f, 0.9f, 0.3f});
        });
    });
    for (const int rings : {3, 4, 8, 160}) {
        add("sphere-of-" + std::to_string(rings) + "-rings", [=] { return with([=](SyntheticScene& parts, int glass) { parts.addSphere(glass, {0, 0.5f, 0}, 0.3f, rings); }); });
    }
    add("slab", [] { return with([](SyntheticScene& parts, int glass) { parts.addBox(glass, {-0.4f, 0.4f, -0.4f}, {0.4f, 0.5f, 0.4f}); }); });
    add("slab-under-grazing-light", [] { return with([](SyntheticScene& parts, int glass) { parts.addBox(glass, {-0.4f, 0.4f, -0.4f}, {0.4f, 0.5f, 0.4f}); }, {-4, 0.62f, 0}, 6.0f); });

    // Several
    add("nested", [] {
        return with([](SyntheticScene& parts, int glass) {
            parts.addSphere(glass, {0, 0.5f, 0}, 0.3f);
            parts.addSphere(parts.material(glassOf(optics::ConstantIndex{1.0})), {0, 0.5f, 0}, 0.2f);
        });
    });
    add("behind-each-other", [] {
        return with([](SyntheticScene& parts, int glass) {
            parts.addSphere(glass, {0, 0.4f, 0}, 0.2f);
            parts.addSphere(glass, {0.05f, 1.2f, 0}, 0.2f);
        });
    });
    add("overlapping", [] {
        return with([](SyntheticScene& parts, int glass) {
            parts.addSphere(glass, {-0.1f, 0.5f, 0}, 0.2f);
            parts.addBox(glass, {-0.1f, 0.4f, -0.1f}, {0.3f, 0.6f, 0.1f});
        });
    });
    add("twelve", [] {
        return with([](SyntheticScene& parts, int glass) {
            for (int i = 0; i < 12; ++i) parts.addSphere(glass, {-0.45f + 0.3f * float(i % 4), 0.5f, -0.3f + 0.3f * float(i / 4)}, 0.12f, 12);
        }, {0.2f, 2.5f, 0.1f}, 20.0f);
    });
    add("thin-walled", [] {
        Setup setup = plain(sphereScene(kGlass));
        setup.scene.materials.front().thinWalled = true;
        return setup;
    });
    add("metal-and-glass", [] {
        return with([](SyntheticScene& parts, int glass) {
            scene::Material metal;
            metal.metallic = 1.0f, metal.roughness = 0.0f;
            parts.addSphere(parts.material(metal), {0.5f, 0.3f, 0}, 0.3f);
            parts.addSphere(glass, {-0.2f, 0.4f, 0}, 0.25f);
        });
    });
    return cases;
}

}  // namespace caustream::stability
