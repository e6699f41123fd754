#include "bench/accuracy/subject.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <iterator>
#include <span>

#include "bench/accuracy/fingerprint.h"
#include "error.h"
#include "render/key_light.h"
#include "scene/builtin_scenes.h"
#include "tests/reference/reference.h"

namespace caustream::bench {

namespace {

const std::string kReferencePrefix = "reference:";
constexpr int kSphereLevels = 5;   // an icosphere of 20,480 faces

Subject subjectOf(const std::string& name, std::span<const std::byte> glb) {
    auto scene = scene::loadGlb(glb, name);
    if (!scene) throw Error(name + ": " + scene.error().message);
    Subject subject;
    subject.name = name;
    subject.fingerprint = fingerprint(std::string_view(reinterpret_cast<const char*>(glb.data()), glb.size()));
    subject.scene = std::move(*scene);
    return subject;
}

Subject referenceSubject(const std::string& name) {
    const std::string own = name.substr(kReferencePrefix.size());
    const reference::Reference reference = reference::load(own);
    const std::vector<std::uint8_t> glb = reference::makeGlb(reference, kSphereLevels);
    Subject subject = subjectOf(name, std::as_bytes(std::span(glb)));
    subject.world = tracer::worldOfJson(reference::sceneFile(own));
    const reference::Window& w = reference.window;
    subject.plane = Window::onPlane(subject.light(), {w.x0, 0, w.z0}, {w.width, 0, 0}, {0, 0, w.width}, w.cells);
    tracer::Image bands{w.cells, w.cells, static_cast<int>(reference.nm.size()), reference.mono7.values, {}};
    for (const nlohmann::json& band : reference.json.at("files").at(own + "_mono7.npy").at("per_wavelength")) {
        bands.relativeL1.push_back(band.at("est_rel_L1_error"));
    }
    subject.storedBands = std::move(bands);
    return subject;
}

}  // namespace

const std::vector<double>& bandsNm() {
    static const std::vector<double> nm = {380, 430, 480, 530, 580, 630, 680};
    return nm;
}

const scene::Light& Subject::light() const { return scene.lights[static_cast<std::size_t>(render::keyLight(scene))]; }

Subject loadSubject(const std::string& name) {
    if (name.starts_with(kReferencePrefix)) return referenceSubject(name);
    Subject subject;
    if (name.ends_with(".glb")) {
        std::ifstream file(name, std::ios::binary);
        if (!file) throw Error("cannot open " + name);
        const std::string bytes{std::istreambuf_iterator<char>(file), {}};
        subject = subjectOf(name, std::as_bytes(std::span(bytes)));
    } else {
        const auto scenes = scene::builtinScenes();
        const auto found = std::ranges::find(scenes, name, &scene::BuiltinScene::name);
        if (found == scenes.end()) throw Error("no scene \"" + name + "\"; there are " + subjectHelp());
        subject = subjectOf(name, std::as_bytes(std::span(found->glb)));
    }
    if (subject.scene.geometry->casterBounds.empty()) throw Error(name + " has no caster, so no caustic to measure");
    subject.world = tracer::worldOf(subject.scene, subject.light(), tracer::ThinWalls::Absent);
    return subject;
}

scene::Scene withShare(scene::Scene scene, double share) {
    scene::Light& light = scene.lights[static_cast<std::size_t>(render::keyLight(scene))];
    const scene::Bounds& caster = scene.geometry->casterBounds;
    const double sine = 0.5 * (caster.max.y - caster.min.y) / glm::distance(light.position, caster.centre());
    light.direction = glm::normalize(caster.centre() - light.position);
    light.outerConeDeg = static_cast<float>(glm::degrees(std::acos(1.0 - (1.0 - std::sqrt(1.0 - sine * sine)) / share)));
    light.innerConeDeg = std::min(light.innerConeDeg, light.outerConeDeg);
    return scene;
}

Subject withShare(const Subject& subject, double share) {
    Subject wide = subject;
    char text[32];
    std::snprintf(text, sizeof text, " at %.3g%%", 100.0 * share);
    wide.name += text;
    wide.fingerprint = fingerprint(subject.fingerprint + text);
    wide.scene = withShare(subject.scene, share);
    wide.world = tracer::worldOf(wide.scene, wide.light(), tracer::ThinWalls::Absent);
    wide.plane.reset();
    wide.storedBands.reset();
    return wide;
}

scene::Scene withMovedLight(const scene::Scene& scene, int steps) {
    scene::Scene moved = scene;
    scene::Light& light = moved.lights[static_cast<std::size_t>(render::keyLight(scene))];
    // To and fro within 2%, never twice the same place in a row of 40.
    const float way = 1e-3f * static_cast<float>(steps % 40 - 20) + 1e-6f * static_cast<float>(steps);
    if (light.type == scene::LightType::Directional) {
        light.direction = glm::normalize(light.direction + way * glm::vec3(1, 0, 0));
    } else {
        light.position.x += way * glm::distance(light.position, scene.geometry->casterBounds.centre());
    }
    return moved;
}

std::string subjectHelp() {
    std::string names;
    for (const scene::BuiltinScene& scene : scene::builtinScenes()) names += std::string(scene.name) + ", ";
    return names + "reference:sphere, reference:prism, reference:gem, FILE.glb";
}

}  // namespace caustream::bench
