// A headless OpenGL 4.5 core context through EGL: a device of any vendor first, surfaceless Mesa second.
#pragma once
#include <memory>
#include <string>
#include <vector>

namespace caustream::gl {

struct ContextOptions {
    std::string gpu = "auto";        // auto | software | an index of listGpus() | part of a renderer's name
    bool requireHardware = false;    // software rendering is then an error
};

struct GpuInfo {
    int index = 0;
    std::string name;                // the device's EGL description, before a context is made
    bool software = false;
};

// The EGL devices of this machine, in EGL's order.
std::vector<GpuInfo> listGpus();

// Current on the thread that made it until it is moved with makeCurrent(). Dies after every GL object.
class Context {
   public:
    // Throws Error: no EGL, no such GPU, no OpenGL 4.5, or software where hardware is required.
    static std::unique_ptr<Context> create(const ContextOptions& options);
    virtual ~Context() = default;

    virtual void makeCurrent() = 0;      // on the calling thread
    virtual void release() = 0;          // so that another thread can take it
    virtual bool lost() = 0;             // the GPU was reset: nothing of this context can be used any more

    const std::string& renderer() const { return renderer_; }   // GL_RENDERER
    bool software() const { return software_; }
    // One sentence for the log when `auto` fell back to software rendering; empty otherwise.
    const std::string& warning() const { return warning_; }

   protected:
    std::string renderer_, warning_;
    bool software_ = false;
};

}  // namespace caustream::gl
