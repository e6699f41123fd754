#include "render_thread.h"

#include <chrono>
#include <cstdio>
#include <exception>
#include <optional>

#include "error.h"
#include "gl/context.h"
#include "gl/shader_library.h"
#include "log.h"
#include "render/pipeline.h"
#include "session/clock.h"

namespace caustream {
namespace {

constexpr std::chrono::milliseconds kShaderPoll{100};  // only with --shader-dir, for who writes shaders
constexpr int kMostOutOfMemory = 8;                    // frames in a row, not one of any viewer drawn in between
constexpr int kEncoderThreads = 2;  // one still as PNG must not hold up another viewer's stream

std::string hashText(std::uint64_t hash) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

std::uint32_t flagsOf(const FrameJob& job, const std::optional<render::Convergence>& reached) {
    if (job.requestId) {
        return protocol::kFrameStill | (reached && reached->converged ? protocol::kFrameConverged : 0u);
    }
    if (job.converge) {
        return job.endsConvergence(reached) ? protocol::kFrameStill | protocol::kFrameConverged : 0u;
    }
    return job.still ? protocol::kFrameStill : 0u;
}

// What of a frame's time a smaller picture would save.
double pictureMs(const render::FrameStats& stats, double encodeMs) {
    double ms = encodeMs;
    for (const render::StageTime& stage : stats.stages) {
        const std::string_view pass = stage.pass;
        const bool pixels = pass.starts_with("camera_") || pass.ends_with("_refraction") || pass == "thesis_receivers" ||
                            pass == "present" || pass == "planar_yuv" || pass == "read_back";
        ms += pixels ? stage.ms : 0.0;
    }
    return ms;
}

// How this frame is encoded: as its view says, as its level of the ladder, or without loss because nothing follows it.
stream::EncodeSettings encodingOf(const FrameJob& job, const std::optional<render::Convergence>& reached) {
    const View& view = *job.shown.view;
    stream::EncodeSettings settings = job.lossless || job.endsConvergence(reached) ? view.encodeLast : view.encode;
    if (job.level != stream::Ladder::kFixed) {
        settings.jpegQuality = stream::Ladder::at(job.level).jpegQuality;
        settings.subsampling = stream::Ladder::at(job.level).subsampling;
    }
    return settings;
}

render::Request requestOf(const FrameJob& job) {
    render::Request request = job.shown.view->request;
    // An answer names its map's hash; the map itself has no anti-aliasing to pay for.
    request.still = job.still || (job.requestId && request.target == render::Target::Spectral);
    request.converge = job.converge;
    request.viewer = job.session;
    if (job.level != stream::Ladder::kFixed) {
        const auto size = stream::Ladder::scaled({request.width, request.height}, job.level);
        request.width = size.width;
        request.height = size.height;
    }
    return request;
}

session::OutgoingFrame outgoingFrame(const FrameJob& job, const render::Frame& frame, const stream::EncodeSettings& settings,
                                     stream::Encoded&& encoded) {
    session::OutgoingFrame outgoing;
    outgoing.header = frameHeader(*job.shown.view, frame, settings, job.level);
    protocol::FrameHeader& header = outgoing.header;
    header.flags |= flagsOf(job, frame.stats.convergence);
    header.inputSeq = job.shown.inputSeq;
    header.stateRev = job.shown.rev;
    header.clientUs = job.shown.clientUs;
    header.holdUs = static_cast<std::uint32_t>(job.startedUs - job.shown.changedUs);
    header.encodeUs = static_cast<std::uint32_t>(encoded.encodeMs * 1e3);
    header.payloadLen = static_cast<std::uint32_t>(encoded.buffer.size() - protocol::kFrameHeaderBytes);
    outgoing.info = streamInfo(*job.shown.view, frame, settings.encoding);
    outgoing.stats = frameStats(frame);
    outgoing.stats.encodeMs = encoded.encodeMs;
    outgoing.stats.holdMs = 1e-3 * header.holdUs;
    outgoing.stats.level = header.level;
    outgoing.pictureMs = pictureMs(frame.stats, encoded.encodeMs);
    outgoing.changedUs = job.shown.changedUs;
    outgoing.encodedUs = session::nowUs();
    outgoing.resting = job.resting();
    outgoing.requestId = job.requestId;
    outgoing.mapHash = hashText(frame.mapHash);
    outgoing.buffer = std::move(encoded.buffer);
    return outgoing;
}

// Whatever comes of drawing it: what may be sent without loss, now or once more, is plain RGB.
bool alwaysJpeg(const FrameJob& job) {
    const View& view = *job.shown.view;
    const bool lossless = view.encodeLast.encoding != protocol::Encoding::Jpeg && (job.still || job.lossless || job.mayEndConvergence());
    return view.encode.encoding == protocol::Encoding::Jpeg && !lossless;
}

}  // namespace

struct RenderThread::Gpu {
    std::unique_ptr<gl::Context> context;
    gl::ShaderLibrary shaders;
    render::Pipeline pipeline;

    explicit Gpu(const Config& config)
        : context(gl::Context::create({.gpu = config.gpu, .requireHardware = config.requireHardware})),
          shaders(config.shaderDir),
          pipeline(*context, shaders) {}
};

RenderThread::RenderThread(const Config& config, std::function<void(Delivery&&)> deliver)
    : config_(config),
      deliver_(std::move(deliver)),
      scheduler_(static_cast<std::uint32_t>(config.gpuMsPerS)),
      testFrames_(config.testFrameBytes, config.testFrameMs),
      encoders_(kEncoderThreads) {
    std::promise<void> warm;
    std::future<void> warmed = warm.get_future();
    thread_ = std::thread([this, &warm] { work(warm); });
    try {
        warmed.get();
    } catch (...) {
        thread_.join();
        throw;
    }
}

RenderThread::~RenderThread() {
    schedule([this](Scheduler&) { stopping_ = true; });
    thread_.join();
}

void RenderThread::collect() {
    schedule([this](Scheduler&) { collecting_ = true; });
}

void RenderThread::work(std::promise<void>& warm) {
    std::optional<Gpu> gpu;
    try {
        const std::uint64_t start = session::nowUs();
        gpu.emplace(config_);
        gpuName_ = gpu->context->renderer();
        if (!gpu->context->warning().empty()) {
            log::warning("gpu").with("message", gpu->context->warning());
        }
        gpu->pipeline.warmUp();
        log::info("gpu").with("renderer", gpuName_).with("warm_ms", (session::nowUs() - start) / 1000);
    } catch (...) {
        gpu.reset();
        warm.set_exception(std::current_exception());
        return;
    }
    warm.set_value();
    serve(*gpu);
}

void RenderThread::serve(Gpu& gpu) {
    std::unique_lock lock(mutex_);
    while (!stopping_ && !lost_) {
        std::uint64_t wakeUs = 0;
        const std::uint64_t now = session::nowUs();
        if (std::exchange(collecting_, false)) {   // before drawing: a server that always has something to draw collects, too
            std::erase_if(stills_, [this](const auto& still) { return !scheduler_.knows(still.first); });
            const std::vector<const scene::Geometry*> shown = scheduler_.geometryShown();
            const std::vector<SessionKey> sessions = scheduler_.sessions();
            lock.unlock();
            busySinceUs_ = now;
            gpu.pipeline.collect(shown, sessions);
            busySinceUs_ = 0;
            lock.lock();
        } else if (std::optional<FrameJob> job = scheduler_.next(now, wakeUs)) {
            lock.unlock();
            draw(gpu, std::move(*job));
            lock.lock();
        } else if (!config_.shaderDir.empty()) {
            wake_.wait_for(lock, kShaderPoll);
            reloadShaders(gpu);
        } else if (wakeUs != 0) {
            wake_.wait_for(lock, std::chrono::microseconds(wakeUs - now));
        } else {
            wake_.wait(lock);
        }
    }
}

void RenderThread::reloadShaders(Gpu& gpu) {
    if (gpu.shaders.reloadIfChanged()) {
        log::info("shaders").with("message", "read again");
        scheduler_.redrawAll();
    }
}

void RenderThread::draw(Gpu& gpu, FrameJob job) {
    busySinceUs_ = job.startedUs;
    failOnPurpose();
    std::string error;
    bool outOfMemory = false;
    render::Frame frame;
    auto still = stills_.find(job.session);
    if (still != stills_.end() && !job.requestId && still->second.view != job.shown.view) {
        stills_.erase(still);  // of a picture that is no more
        still = stills_.end();
    }
    if (testFrames_.wanted()) {
        stream::Encoded encoded;
        frame = testFrames_.draw(job, encoded);
        ++frames_;
        notice(gpu, false);
        finish(job, frame);
        session::OutgoingFrame outgoing = outgoingFrame(job, frame, job.shown.view->encode, std::move(encoded));
        outgoing.header.flags |= protocol::kFrameTest;
        deliver_({std::move(job), std::move(outgoing), {}});
        return;
    }
    if (job.lossless && still != stills_.end()) {
        frame = std::move(still->second.frame);
        stills_.erase(still);
    } else {
        try {
            render::Request request = requestOf(job);
            if (alwaysJpeg(job)) {
                request.pixels = gpu.pipeline.jpegPixels(encodingOf(job, {}).subsampling == stream::Subsampling::Half);
            }
            frame = gpu.pipeline.run(request);
            ++frames_;
            ++(frame.stats.lightReused ? lightReuses_ : lightRuns_);
        } catch (const std::exception& problem) {
            outOfMemory = dynamic_cast<const OutOfMemory*>(&problem);
            ++failures_;
            error = problem.what();
            log::error("render").with("message", error);
        }
    }
    notice(gpu, outOfMemory);
    finish(job, frame);
    if (!error.empty()) {
        deliver_({std::move(job), {}, std::move(error)});
        return;
    }
    if (job.still && !job.lossless && !job.converge && !job.requestId && job.shown.view->losslessFollows()) {
        stills_.insert_or_assign(job.session, Still{job.shown.view, frame});
    }
    const stream::EncodeSettings settings = encodingOf(job, frame.stats.convergence);
    encoders_.submit(std::move(frame), settings, [this, job = std::move(job), settings](render::Frame&& drawn, stream::Encoded&& encoded) {
        if (!encoded.error.empty()) {
            deliver_({job, {}, std::move(encoded.error)});
            return;
        }
        deliver_({job, outgoingFrame(job, drawn, settings, std::move(encoded)), {}});
    });
}

// Drawn or failed: whose time it was, and what its session waits for next.
void RenderThread::finish(const FrameJob& job, const render::Frame& frame) {
    busySinceUs_ = 0;
    const std::lock_guard lock(mutex_);
    scheduler_.spent(job.session, session::nowUs() - job.startedUs);
    scheduler_.drawn(job, frame.stats.convergence);
}

// Whether there is a GPU left to draw with; the program's watchdog looks at lost().
void RenderThread::notice(Gpu& gpu, bool outOfMemory) {
    outOfMemory_ = outOfMemory ? outOfMemory_ + 1 : 0;
    const auto purpose = static_cast<std::uint64_t>(config_.testLoseGpuAfterFrames);
    if (gpu.context->lost()) {
        lost_ = "the GPU was reset";
    } else if (outOfMemory_ >= kMostOutOfMemory) {
        lost_ = "the GPU has no memory for anyone's picture";
    } else if (purpose > 0 && frames_ >= purpose) {
        lost_ = "the GPU is lost, as --test-lose-gpu-after-frames asks";
    }
}

void RenderThread::failOnPurpose() const {
    const auto frames = static_cast<std::uint64_t>(config_.testHangAfterFrames);
    while (frames > 0 && frames_ >= frames) {
        std::this_thread::sleep_for(std::chrono::seconds(1));
    }
}

}  // namespace caustream
