// Front and back layers of one caster in the camera's view, drawn and cleared only where the caster can be.
#pragma once
#include "gl/names.h"
#include "gl/shader_library.h"
#include "render/gpu_scene.h"
#include "render/passes/caster_layers.h"
#include "render/view.h"

namespace caustream::render {

// Pixels of an image, origin at the lower left as GL counts.
struct PixelBox {
    int x = 0, y = 0, width = 0, height = 0;
    bool empty() const { return width <= 0 || height <= 0; }
    bool operator==(const PixelBox&) const = default;
};

// Where `bounds` can show in `view` at width x height, with a margin of one pixel for filtered lookups; empty when out of
// view, everything when the bounds reach behind the eye.
PixelBox projectedBox(const scene::Bounds& bounds, const View& view, int width, int height);

class CameraCasters {
   public:
    struct Inputs {
        const GpuScene& scene;
        const scene::Object& caster;
        const View& view;         // the camera's
        int width, height;        // pixels
        bool clearAll = false;    // clears outside the box too: only for showing the layers
    };
    struct Outputs {
        gl::Texture& front;       // RGBA32F as CasterLayers makes it; undefined outside the box
        gl::Texture& back;
    };

    explicit CameraCasters(gl::ShaderLibrary& shaders) : layers_(shaders) {}

    // The box that was drawn; when it is empty nothing was.
    PixelBox run(const Inputs& in, const Outputs& out);
    // The front layer's values once more, DEPTH_COMPONENT32F: a pass over the box that tests against it skips what is empty.
    const gl::Texture& frontDepth() const { return layers_.depth(); }

   private:
    CasterLayers layers_;
};

}  // namespace caustream::render
