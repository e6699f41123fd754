#include "bench/accuracy/renderer.h"

#include <algorithm>
#include <array>

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
