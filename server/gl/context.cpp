#include "gl/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <cctype>
#include <cstring>

#include "error.h"
#include "gl/debug.h"

#ifndef EGL_RENDERER_EXT  // EGL_EXT_device_query_name, younger than Debian 12's headers
#define EGL_RENDERER_EXT 0x335F
#endif

namespace caustream::gl {

namespace {

bool hasExtension(const char* list, const char* name) {
    if (!list) return false;
    const std::string padded = std::string(" ") + list + " ";
    return padded.find(std::string(" ") + name + " ") != std::string::npos;
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

std::vector<EGLDeviceEXT> eglDevices() {
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!hasExtension(client, "EGL_EXT_device_enumeration") && !hasExtension(client, "EGL_EXT_device_base")) return {};
    EGLint count = 0;
    if (!eglQueryDevicesEXT(0, nullptr, &count) || count <= 0) return {};
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    if (!eglQueryDevicesEXT(count, devices.data(), &count)) return {};
    devices.resize(static_cast<std::size_t>(count));
    return devices;
}

GpuInfo describe(EGLDeviceEXT device, int index) {
    const char* extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
    GpuInfo info{index, "GPU " + std::to_string(index), hasExtension(extensions, "EGL_MESA_device_software")};
    if (info.software) {
        info.name = "software";
    } else if (hasExtension(extensions, "EGL_EXT_device_query_name")) {
        if (const char* name = eglQueryDeviceStringEXT(device, EGL_RENDERER_EXT)) info.name = name;
    } else if (hasExtension(extensions, "EGL_EXT_device_drm")) {
        if (const char* file = eglQueryDeviceStringEXT(device, EGL_DRM_DEVICE_FILE_EXT)) info.name = file;
    }
    return info;
}

class EglContext final : public Context {
   public:
    // Takes the display, makes a context on it; throws Error when it cannot.
    explicit EglContext(EGLDisplay display) : display_(display) {
        EGLint major = 0, minor = 0;
        if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, &major, &minor)) throw Error("EGL does not start");
        if (!eglBindAPI(EGL_OPENGL_API)) throw Error("EGL offers no desktop OpenGL");
        const EGLint configAttributes[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        if (!eglChooseConfig(display_, configAttributes, &config, 1, &count) || count < 1) config = EGL_NO_CONFIG_KHR;
        const std::vector<EGLint> attributes = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                     EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE, EGL_NONE};
        context_ = createContext(config, attributes);
        if (context_ == EGL_NO_CONTEXT) throw Error("no OpenGL 4.5 core context");
        makeCurrent();
        const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
        renderer_ = name ? name : "unknown";
        const std::string known = lower(renderer_);
        software_ = known.find("llvmpipe") != std::string::npos || known.find("softpipe") != std::string::npos ||
                    known.find("swrast") != std::string::npos;
        installDebugRecorder();
    }

    ~EglContext() override {
        release();
        if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
        eglTerminate(display_);
    }

    void makeCurrent() override {
        if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
            throw Error("EGL refuses a context without a surface");
        }
    }
    bool lost() override { return glGetGraphicsResetStatus() != GL_NO_ERROR; }
    void release() override { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }
    void warn(std::string text) { warning_ = std::move(text); }

   private:
    // One that tells when the GPU was reset, where the driver can: a software renderer has nothing to reset.
    EGLContext createContext(EGLConfig config, std::vector<EGLint> attributes) const {
        std::vector<EGLint> telling = {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET};
        telling.insert(telling.end(), attributes.begin(), attributes.end());
        const EGLContext context = eglCreateContext(display_, config, EGL_NO_CONTEXT, telling.data());
        return context != EGL_NO_CONTEXT ? context : eglCreateContext(display_, config, EGL_NO_CONTEXT, attributes.data());
    }

    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
};

EGLDisplay surfacelessDisplay() {
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!hasExtension(client, "EGL_MESA_platform_surfaceless")) return EGL_NO_DISPLAY;
    return eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
}

// Whether the options ask for this device: by kind, index or part of its name.
bool wanted(const GpuInfo& gpu, const std::string& choice) {
    if (choice == "auto") return !gpu.software;
    if (choice == "software") return gpu.software;
    if (std::all_of(choice.begin(), choice.end(), [](unsigned char c) { return std::isdigit(c); })) {
        return std::to_string(gpu.index) == choice;
    }
    return lower(gpu.name).find(lower(choice)) != std::string::npos;
}

}  // namespace

std::vector<GpuInfo> listGpus() {
    std::vector<GpuInfo> gpus;
    for (EGLDeviceEXT device : eglDevices()) gpus.push_back(describe(device, static_cast<int>(gpus.size())));
    return gpus;
}

std::unique_ptr<Context> Context::create(const ContextOptions& options) {
    const std::string choice = options.gpu.empty() ? "auto" : options.gpu;
    std::string reasons;
    std::unique_ptr<EglContext> context;

    // The devices that fit, in EGL's order; the first that makes a context is taken.
    const std::vector<EGLDeviceEXT> devices = eglDevices();
    for (std::size_t i = 0; i < devices.size() && !context; ++i) {
        const GpuInfo gpu = describe(devices[i], static_cast<int>(i));
        if (!wanted(gpu, choice)) continue;
        try {
            context = std::make_unique<EglContext>(
                eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
        } catch (const Error& error) {
            reasons += " " + gpu.name + ": " + error.what() + ".";
        }
    }

    // Surfaceless Mesa serves `auto` and `software` where devices do not.
    if (!context && (choice == "auto" || choice == "software")) {
        try {
            context = std::make_unique<EglContext>(surfacelessDisplay());
        } catch (const Error& error) {
            reasons += std::string(" surfaceless: ") + error.what() + ".";
        }
    }
    if (!context) {
        throw Error("no OpenGL 4.5 through EGL for --gpu " + choice + ";" + reasons +
                    " try --gpu list, or install libgl1-mesa-dri for software rendering");
    }
    if (context->software() && options.requireHardware) {
        throw Error("only software rendering (" + context->renderer() +
                    ") is available and --require-hardware is set; check the GPU's driver with --gpu list");
    }
    if (context->software() && choice == "auto") {
        context->warn("no hardware GPU answers; rendering in software with " + context->renderer());
    }
    return context;
}

}  // namespace caustream::gl
