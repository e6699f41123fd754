// The renderer as the bench drives it: one context, and for every configuration a pipeline of its own, so that none pays
// for another's images.
#pragma once
#include <map>
#include <memory>
#include <string>

#include "bench/accuracy/configuration.h"
#include "bench/accuracy/window.h"
#include "gl/context.h"
#include "gl/shader_library.h"
#include "render/pipeline.h"

namespace caustream::bench {

class Renderer {
   public:
    explicit Renderer(const std::string& gpu);

    const gl::Context& context() const { return *context_; }
    // One for each configuration and subject (its fingerprint).
    render::Pipeline& pipeline(const Configuration& configuration, const std::string& subject);
    // Drops every pipeline.
    void forget() { pipelines_.clear(); }

   private:
    std::unique_ptr<gl::Context> context_;
    gl::ShaderLibrary shaders_;
    std::map<std::string, std::unique_ptr<render::Pipeline>> pipelines_;
};

// The spectral map in F32; a picture of `size` a side at 0 EV above the reference unless the request says otherwise.
render::Request mapRequest(const scene::Scene& scene, const Configuration& configuration);
render::Request pictureRequest(const scene::Scene& scene, const Configuration& configuration, int size);

// The request's map over the window's cells as resample() has it. Of traced transport with the outer map, which holds what
// bounces about, wherever it lands.
std::vector<float> mapOnWindow(render::Pipeline& pipeline, const render::Request& request, const Window& window, int samples = 4);
// The same where the frame of the inner map is there already.
std::vector<float> mapOnWindow(render::Pipeline& pipeline, const render::Request& request, const render::Frame& inner, const Window& window, int samples = 4);

// Milliseconds of a frame: stage timestamps on hardware, wall clock around a finish on software.
struct FrameTime {
    double whole = 0;
    double light = 0;     // stages from the light's side; 0 of a camera move
};
FrameTime frameTime(const render::Frame& frame, bool software);

}  // namespace caustream::bench
