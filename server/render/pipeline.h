// The renderer: every pass, the images that travel between them, and the cache that lets a moving camera reuse light.
// Lives on the render thread, which owns the GL context.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "render/frame.h"

namespace caustream::gl {
class Context;
class ShaderLibrary;
}

namespace caustream::render {

class Pipeline {
   public:
    Pipeline(gl::Context& context, gl::ShaderLibrary& shaders);
    ~Pipeline();

    // Compiles every shader; `progress(done, total)` after each. Throws gl::ShaderError.
    void warmUp(const std::function<void(int, int)>& progress = {});

    // Draws and reads back one frame. Throws Error with a sentence when the GPU refuses (out of memory, lost).
    Frame run(const Request& request);

    // What `Request::pixels` is best for a JPEG on this GPU; `halfChroma`: of 4:2:0.
    PixelLayout jpegPixels(bool halfChroma) const;

    // Forgets what was made for geometry that is not `shown` and for other viewers than these: it is made again when it is
    // wanted again. So many viewers, so many poses of light are kept, so that all of them can converge.
    void collect(std::span<const scene::Geometry* const> shown, std::span<const std::uint64_t> viewers);

   private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// The names `Target::Pass` knows: one per pass with a picture to show.
std::span<const std::string> passNames();

}  // namespace caustream::render
