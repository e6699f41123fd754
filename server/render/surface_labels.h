// The labels of a picture, for data sets: "depth", "normals" and "caster_mask" of Target::Pass, as numbers or to look at.
#pragma once
#include <string_view>

#include "gl/shader_library.h"
#include "gl/stage_timer.h"
#include "render/frame.h"
#include "render/gpu_scene.h"
#include "render/passes/first_surface.h"
#include "render/passes/present.h"
#include "render/view.h"

namespace caustream::render {

// Whether a pass's picture is one of the labels: drawn without light.
bool isLabel(const Request& request);

class SurfaceLabels {
   public:
    explicit SurfaceLabels(gl::ShaderLibrary& shaders) : pass_(shaders) {}

    // Draws the label that `request.pass` names. With Sample::F32 `frame` gets its values: depth in m along the view axis,
    // infinity where there is nothing (1 band); unit normals in world space, 0 where there is nothing (3); the number of
    // the caster seen, from 1, else 0 (1). Otherwise `output` gets a picture of them, rows top to bottom, and is the
    // caller's to read.
    void run(const Request& request, const GpuScene& gpu, const View& view, gl::StageTimer& timer, Present& present,
             gl::Texture& output, Frame& frame);

   private:
    FirstSurface pass_;
    gl::Texture surface_, label_;
};

}  // namespace caustream::render
