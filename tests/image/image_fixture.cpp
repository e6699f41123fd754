#include "tests/image/image_fixture.h"

#include <cmath>
#include <cstring>
#include <glm/trigonometric.hpp>

#include "gl/context.h"
#include "gl/debug.h"
#include "gl/shader_library.h"

namespace caustream::image {

namespace {

struct Renderer {
    std::unique_ptr<gl::Context> context = gl::Context::create({.gpu = "software"});
    gl::ShaderLibrary shaders;
    render::Pipeline pipeline{*context, shaders};
};

Renderer& renderer() {
    static Renderer renderer;
    return renderer;
}

}  // namespace

ImageTest::~ImageTest() { EXPECT_THAT(gl::takeDebugMessages(), testing::IsEmpty()); }

render::Pipeline& ImageTest::pipeline() { return renderer().pipeline; }

std::unique_ptr<render::Pipeline> ImageTest::freshPipeline() {
    return std::make_unique<render::Pipeline>(*renderer().context, renderer().shaders);
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
    const double gone = l.deposited + l.absorbed + l.reflected + l.totalReflection + l.rejected + l.leftMap + l.noReceiver;
    return l.onCasters > 0.0 ? std::abs(l.onCasters - gone) / l.onCasters : gone;
}

std::vector<double> floorLight(const render::Frame& frame, const scene::Light& light, double half, int cells) {
    constexpr int kSamples = 48;   // several in a texel, or a focus is missed
    const std::vector<float> map = floats(frame);
    const glm::dmat4 toMap(frame.lightMatrix);
    std::vector<double> sums(static_cast<std::size_t>(cells * cells));
    for (int j = 0; j < cells * kSamples; ++j) {
        for (int i = 0; i < cells * kSamples; ++i) {
            const glm::dvec3 at(half * ((2.0 * i + 1.0) / (cells * kSamples) - 1.0), 0.0, half * ((2.0 * j + 1.0) / (cells * kSamples) - 1.0));
            const glm::dvec4 clip = toMap * glm::dvec4(at, 1.0);
            const int column = static_cast<int>(std::floor((0.5 + 0.5 * clip.x / clip.w) * frame.width));
            const int row = static_cast<int>(std::floor((0.5 + 0.5 * clip.y / clip.w) * frame.height));
            if (clip.w <= 0.0 || column < 0 || row < 0 || column >= frame.width || row >= frame.height) continue;
            const glm::dvec3 to = glm::dvec3(light.position) - at;
            const double r = glm::length(to);
            const double direct = light.type == scene::LightType::Directional ? 1.0 : to.y / (r * r * r);
            sums[static_cast<std::size_t>((j / kSamples) * cells + i / kSamples)] +=
                map[static_cast<std::size_t>((row * frame.width + column) * frame.bands + 1)] * direct / (kSamples * kSamples);
        }
    }
    return sums;
}

scene::Scene finish(const tests::SyntheticScene& parts, const scene::Light& light) {
    scene::Scene scene;
    scene.name = "test";
    auto geometry = std::make_shared<scene::Geometry>(*parts.geometry());
    for (const scene::Object& object : geometry->objects) {
        if (parts.materials[static_cast<std::size_t>(object.material)].caster) geometry->casterBounds.add(object.bounds);
    }
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

}  // namespace caustream::image
