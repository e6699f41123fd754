#include "bench/accuracy/renderer.h"

#include <algorithm>
#include <array>
#include <functional>

namespace caustream::bench {

Renderer::Renderer(const std::string& gpu) : context_(gl::Context::create({.gpu = gpu})) {
    render::Pipeline(*context_, shaders_).warmUp();
}

render::Pipeline& Renderer::pipeline(const Configuration& configuration, const std::string& subject) {
    auto& pipeline = pipelines_[subject + configuration.name()];
    if (!pipeline) pipeline = std::make_unique<render::Pipeline>(*context_, shaders_);
    return *pipeline;
}

render::Request mapRequest(const scene::Scene& scene, const Configuration& configuration) {
    render::Request request;
    request.scene = std::make_shared<const scene::Scene>(scene);
    request.camera = scene.cameras.front();
    request.transport = configuration.transport;
    request.target = render::Target::Spectral;
    request.sample = render::Sample::F32;
    return request;
}

render::Request pictureRequest(const scene::Scene& scene, const Configuration& configuration, int size) {
    render::Request request = mapRequest(scene, configuration);
    request.target = render::Target::Composite;
    request.sample = render::Sample::U8;
    request.width = request.height = size;
    return request;
}

std::vector<float> mapOnWindow(render::Pipeline& pipeline, const render::Request& request, const render::Frame& inner, const Window& window, int samples) {
    std::vector<float> cells = resample(inner, window, samples);
    if (!inner.stats.convergence && request.transport.mode != render::Mode::Traced) return cells;
    render::Request around = request;
    around.outerMap = true;
    around.converge = false;
    const std::vector<float> outer = resample(pipeline.run(around), window, samples);
    std::transform(outer.begin(), outer.end(), cells.begin(), cells.begin(), std::plus<>());
    return cells;
}

std::vector<float> mapOnWindow(render::Pipeline& pipeline, const render::Request& request, const Window& window, int samples) {
    return mapOnWindow(pipeline, request, pipeline.run(request), window, samples);
}

FrameTime frameTime(const render::Frame& frame, bool software) {
    constexpr std::array kCamera = {"camera_receivers", "camera_casters", "dispersive_refraction", "present", "read_back"};
    FrameTime time;
    for (const render::StageTime& stage : frame.stats.stages) {
        time.whole += stage.ms;
        if (std::ranges::find(kCamera, stage.pass) == kCamera.end()) time.light += stage.ms;
    }
    if (software) time.whole = frame.stats.renderMs;
    return time;
}

}  // namespace caustream::bench
