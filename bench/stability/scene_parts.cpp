#include "bench/stability/scene_parts.h"

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

namespace caustream::stability {

void findBounds(scene::Geometry& geometry, const std::vector<scene::Material>& materials) {
    geometry.bounds = geometry.casterBounds = {};
    for (scene::Object& object : geometry.objects) {
        object.bounds = {};
        for (std::uint32_t i = 0; i < object.indexCount; ++i) {
            object.bounds.add(geometry.vertices[geometry.indices[object.firstIndex + i]].position);
        }
        geometry.bounds.add(object.bounds);
        if (materials[static_cast<std::size_t>(object.material)].caster) geometry.casterBounds.add(object.bounds);
    }
}

scene::Scene finish(const tests::SyntheticScene& parts, const scene::Light& light) {
    scene::Scene scene;
    scene.name = "test";
    auto geometry = std::make_shared<scene::Geometry>(*parts.geometry());
    findBounds(*geometry, parts.materials);
    scene.geometry = geometry;
    scene.materials = parts.materials;
    scene.lights = {light};
    scene::Camera camera;
    camera.eye = {0, 2, 3};
    scene.cameras = {camera};
    return scene;
}

scene::Material glassOf(const optics::Dispersion& dispersion) {
    scene::Material material;
    material.caster = true;
    material.dispersion = dispersion;
    return material;
}

scene::Material white() { return {}; }

void addFloor(tests::SyntheticScene& parts) { parts.addQuad(parts.material(white()), {-5, 0, 5}, {10, 0, 0}, {0, 0, -10}); }

scene::Light spotAbove(const glm::vec3& position, const glm::vec3& target, float halfAngleDeg) {
    scene::Light light;
    light.name = "key";
    light.position = position;
    light.direction = glm::normalize(target - position);
    light.innerConeDeg = light.outerConeDeg = halfAngleDeg;
    return light;
}

scene::Scene sphereScene(const optics::Dispersion& dispersion) {
    tests::SyntheticScene parts;
    parts.addSphere(parts.material(glassOf(dispersion)), {0, 0.5f, 0}, 0.3f);
    addFloor(parts);
    return finish(parts, spotAbove({0.5f, 2.5f, 0.3f}, {0, 0.5f, 0}, 12.0f));
}

scene::Scene prismScene(const optics::Dispersion& dispersion) {
    tests::SyntheticScene parts;
    const glm::vec3 a(-0.25f, 0.4f, 0.3f), b(0.25f, 0.4f, 0.3f), c(0.0f, 0.83f, 0.3f), d(0, 0, -0.6f);
    const int glass = parts.material(glassOf(dispersion));
    parts.addFlat(glass, {a, b, c, a + d, c + d, b + d, a, a + d, b, b, a + d, b + d,
                          b, b + d, c, c, b + d, c + d, c, c + d, a, a, c + d, a + d});
    addFloor(parts);
    return finish(parts, spotAbove({0.55f, 2.6f, 0.05f}, {0.13f, 0.6f, 0}, 5.0f));
}

scene::Scene scaled(scene::Scene scene, float by) {
    scene = changed(scene, [by](scene::Geometry& geometry) {
        for (scene::Vertex& vertex : geometry.vertices) vertex.position *= by;
    });
    for (scene::Light& light : scene.lights) {
        light.position *= by;
        if (light.type != scene::LightType::Directional) light.intensity *= by * by;
    }
    for (scene::Camera& camera : scene.cameras) camera.eye *= by, camera.target *= by;
    return scene;
}

scene::Scene shifted(scene::Scene scene, const glm::vec3& by) {
    scene = changed(scene, [&](scene::Geometry& geometry) {
        for (scene::Vertex& vertex : geometry.vertices) vertex.position += by;
    });
    for (scene::Light& light : scene.lights) light.position += by;
    for (scene::Camera& camera : scene.cameras) camera.eye += by, camera.target += by;
    return scene;
}

render::Request mapRequest(const scene::Scene& scene) {
    render::Request request;
    request.scene = std::make_shared<const scene::Scene>(scene);
    request.camera = scene.cameras.front();
    request.transport.photonGrid = request.transport.mapSize = 128;
    request.target = render::Target::Spectral;
    request.sample = render::Sample::F32;
    request.width = request.height = 128;
    return request;
}

render::Request pictureRequest(const scene::Scene& scene, render::Sample sample) {
    render::Request request = mapRequest(scene);
    request.target = render::Target::Composite;
    request.sample = sample;
    request.exposureEv = 0.0f;
    return request;
}

std::vector<float> floats(const render::Frame& frame) {
    std::vector<float> values(frame.pixels.size() / sizeof(float));
    std::memcpy(values.data(), frame.pixels.data(), values.size() * sizeof(float));
    return values;
}

bool allFinite(const std::vector<float>& values) {
    for (const float value : values) {
        if (!std::isfinite(value)) return false;
    }
    return true;
}

double ledgerGap(const render::EnergyLedger& l) {
    const double gone = l.deposited + l.absorbed + l.reflected + l.totalReflection + l.rejected + l.leftMap + l.noReceiver + l.cut;
    return l.onCasters > 0.0 ? std::abs(l.onCasters - gone) / l.onCasters : gone;
}

}  // namespace caustream::stability
