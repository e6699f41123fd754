#include "plan_report.h"

#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <vector>

#include "error.h"
#include "gl/context.h"
#include "gl/shader_library.h"
#include "render/pipeline.h"
#include "resolve_request.h"
#include "scene/builtin_scenes.h"
#include "scene/gltf_loader.h"
#include "session/scene_overrides.h"
#include "session/scene_summary.h"

namespace caustream {
namespace {

constexpr float kMove = 1e-3f;   // of a distance: enough to be another pose, too little to be another plan

scene::Scene load(const std::string& name) {
    tl::expected<scene::Scene, scene::LoadError> loaded;
    if (name.ends_with(".glb") || name.find('/') != name.npos) {
        std::ifstream in(name, std::ios::binary);
        if (!in) throw Error("plan; cannot read " + name + "; check the path");
        const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
        loaded = scene::loadGlb(std::as_bytes(std::span(bytes)), name);
    } else {
        loaded = scene::loadBuiltin(name);
    }
    if (!loaded) throw Error("plan; " + loaded.error().message);
    return std::move(*loaded);
}

template <class T>
T checked(tl::expected<T, protocol::DecodeError> value) {
    if (value) return std::move(*value);
    throw Error("plan; --set " + value.error().field + ": " + value.error().message);
}

render::Request requestOf(const scene::Scene& base, const std::vector<protocol::Setting>& settings) {
    const protocol::State plain;
    const protocol::Json document = session::resolvedDocument(plain, base, base.cameras.front());
    protocol::Json patch = checked(protocol::settingsPatch(document, settings));
    if (patch.contains("stream") && patch["stream"].is_object() && patch["stream"].value("target", protocol::Json()) == "spectral") {
        // As a map travels, unless the settings say otherwise
        protocol::Json stream = {{"encoding", "raw"}, {"sample", "f32"}};
        protocol::extendPatch(stream, patch["stream"]);
        patch["stream"] = stream;
    }
    const protocol::Applied applied = checked(protocol::applyPatch(protocol::toJson(plain), patch, {}, true));
    auto scene = std::make_shared<const scene::Scene>(checked(session::withOverrides(base, applied.state)));
    return checked(resolveRequest(applied.state, std::move(scene))).request;
}

void moveLights(render::Request& request) {
    scene::Scene moved = *request.scene;
    for (scene::Light& light : moved.lights) {
        light.position.x += kMove * moved.geometry->bounds.radius();
        light.direction = glm::normalize(light.direction + glm::vec3(kMove, 0.0f, 0.0f));
    }
    request.scene = std::make_shared<const scene::Scene>(std::move(moved));
}

void tell(std::string& text, const std::string& title, const render::Frame& frame) {
    std::size_t widest = 0;
    for (const render::PlanEntry& entry : frame.stats.plan) widest = std::max(widest, entry.pass.size());
    text += title + "\n";
    for (const render::PlanEntry& entry : frame.stats.plan) {
        text += std::string(entry.run ? "  run   " : "  skip  ") + entry.pass + std::string(widest + 2 - entry.pass.size(), ' ') + entry.reason + "\n";
        for (const std::string& part : entry.without) text += std::string(widest + 10, ' ') + "without " + part + "\n";
    }
}

}  // namespace

std::string planReport(const Config& config) {
    render::Request request = requestOf(load(config.planScene), config.settings);
    const auto context = gl::Context::create({.gpu = config.gpu, .requireHardware = config.requireHardware});
    gl::ShaderLibrary shaders(config.shaderDir);
    render::Pipeline pipeline(*context, shaders);

    const render::Frame first = pipeline.run(request);
    std::string text = config.planScene + " on " + context->renderer() + "\n";
    for (const std::string& warning : first.stats.warnings) text += "warning: " + warning + "\n";
    if (!first.stats.choice.empty()) text += first.stats.choice + "\n";
    tell(text, "\nthe first frame", first);
    request.camera.eye += kMove * (request.camera.eye - request.camera.target);
    tell(text, "\nthe next, after the camera moved", pipeline.run(request));
    moveLights(request);
    const render::Frame moved = pipeline.run(request);
    tell(text, "\nthe next, after the lights moved", moved);
    if (moved.stats.convergence) {
        request.converge = true;
        tell(text, "\nthe next, at rest, of those that converge", pipeline.run(request));
    }
    return text;
}

}  // namespace caustream
