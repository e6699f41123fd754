// Everything seen from the camera: the receivers and, before them, the casters.
#pragma once
#include <cstdint>
#include <map>
#include <span>

#include "gl/names.h"
#include "gl/shader_library.h"
#include "gl/stage_timer.h"
#include "render/frame.h"
#include "render/gpu_scene.h"
#include "render/light_side.h"
#include "render/lighting.h"
#include "render/passes/camera_casters.h"
#include "render/passes/camera_paths.h"
#include "render/passes/camera_receivers.h"
#include "render/passes/dispersive_refraction.h"
#include "render/passes/thesis_refraction.h"
#include "render/plan.h"
#include "render/progressive_picture.h"
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
        const ExactSurfaces* surfaces = nullptr;   // where the plan is to trace
        double photons = 1.0;      // in the map so far: how good the picture's light is
        float scale = 1.0f;        // as `present` multiplies it
    };

    explicit CameraSide(gl::ShaderLibrary& shaders)
        : shaders_(shaders), receivers_(shaders), casters_(shaders), refraction_(shaders), thesisRefraction_(shaders), paths_(shaders) {}

    // Submits the passes that the plan runs. At rest the picture is added to the mean of those before.
    void run(const Inputs& in, gl::StageTimer& timer);
    // Compile every variant, so that no frame has to.
    void warmUpReceivers() { receivers_.warmUp(); }
    void warmUpCasters() { refraction_.warmUp(); }

    // Forgets the pictures of all other viewers.
    void keepOnly(std::span<const std::uint64_t> viewers);

    // Of the last frame: RGBA16F or 32F, linear BT.709 radiance over radianceUnit(). `exact`: without passage from moving to rest and back.
    ProgressivePicture::Shown shown(bool exact) const;
    const ProgressivePicture& progress() const { return canvas_->progress; }
    const gl::Texture& front() const { return front_; }   // layer of the last caster, for looking at the pass

   private:
    void draw(const Inputs& in, const CameraPaths::Settings& settings, gl::StageTimer& timer);
    void rest(const Inputs& in, gl::StageTimer& timer);
    void tracePaths(const Inputs& in, const CameraPaths::Settings& settings, gl::StageTimer& timer);
    void seeThrough(const Inputs& in, const std::vector<const scene::Object*>& order, gl::StageTimer& timer);

    gl::ShaderLibrary& shaders_;
    CameraReceivers receivers_;
    CameraCasters casters_;
    DispersiveRefraction refraction_;
    ThesisRefraction thesisRefraction_;
    CameraPaths paths_;
    // What one viewer looks at, from frame to frame: others' frames come in between.
    struct Canvas {
        explicit Canvas(gl::ShaderLibrary& shaders) : progress(shaders) {}
        gl::Texture color;
        ProgressivePicture progress;
        bool inARow = false;                      // the last picture is one of those that `progress` watches
    };
    std::map<std::uint64_t, Canvas> canvases_;
    Canvas* canvas_ = nullptr;                    // of the last frame
    gl::Texture depth_, front_, back_;
};

}  // namespace caustream::render
