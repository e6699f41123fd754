// Everything seen from the camera: the receivers and, before them, the casters.
#pragma once
#include "gl/names.h"
#include "gl/shader_library.h"
#include "gl/stage_timer.h"
#include "render/frame.h"
#include "render/gpu_scene.h"
#include "render/light_side.h"
#include "render/lighting.h"
#include "render/passes/camera_casters.h"
#include "render/passes/camera_receivers.h"
#include "render/passes/dispersive_refraction.h"
#include "render/passes/thesis_refraction.h"
#include "render/plan.h"
#include "render/view.h"

namespace caustream::render {

class CameraSide {
   public:
    struct Inputs {
        const Request& request;
        const GpuScene& gpu;
        const View& view;          // the camera's
        const Lighting& lighting;
        const LightMaps& maps;
        const RenderPlan& plan;
        int width, height;         // pixels drawn, which `present` may average
    };

    explicit CameraSide(gl::ShaderLibrary& shaders)
        : receivers_(shaders), casters_(shaders), refraction_(shaders), thesisRefraction_(shaders) {}

    // Submits the passes that the plan runs.
    void run(const Inputs& in, gl::StageTimer& timer);
    // Compile every variant, so that no frame has to.
    void warmUpReceivers() { receivers_.warmUp(); }
    void warmUpCasters() { refraction_.warmUp(); }

    const gl::Texture& color() const { return color_; }   // RGBA16F, linear BT.709 radiance over radianceUnit()
    const gl::Texture& front() const { return front_; }   // layer of the last caster, for looking at the pass

   private:
    void seeThrough(const Inputs& in, gl::StageTimer& timer);

    CameraReceivers receivers_;
    CameraCasters casters_;
    DispersiveRefraction refraction_;
    ThesisRefraction thesisRefraction_;
    gl::Texture color_, depth_, front_, back_;
};

}  // namespace caustream::render
