#include "service.h"

#include <sstream>
#include <utility>

#include "embedded/web.h"
#include "gl/names.h"
#include "log.h"
#include "session/clock.h"
#include "session/random_id.h"

namespace caustream {
namespace {

constexpr std::uint64_t kDrainUs = 2'000'000;     // for the viewers to take their leave
constexpr std::uint64_t kStuckUs = 20'000'000;    // one frame on the slowest software renderer takes less

net::ServerOptions serverOptions(const Config& config, const protocol::Limits& limits) {
    return {.bind = config.bind,
            .port = config.port,
            .maxTextBytes = limits.textBytes,
            .maxBinaryBytes = limits.binaryBytes,
            .pingS = static_cast<int>(limits.pingS),
            .deadS = static_cast<int>(limits.deadS),
            .checkHost = config.token.empty()};
}

protocol::Limits limitsOf(const Config& config) {
    protocol::Limits limits;
    limits.sessions = static_cast<std::uint32_t>(config.maxSessions);
    limits.gpuMsPerS = static_cast<std::uint32_t>(config.gpuMsPerS);
    limits.viewerBytes = config.viewerBytes;
    limits.assetCacheBytes = config.assetCacheBytes;
    return limits;
}

// Delivers a frame even where the task that carries it has to be copied.
template <typename T>
auto shared(T&& value) {
    return std::make_shared<std::decay_t<T>>(std::forward<T>(value));
}

}  // namespace

Service::Service(const Config& config)
    : config_(config),
      desk_{.config = config_, .limits = limitsOf(config), .serverId = session::randomId()},
      server_(serverOptions(config_, desk_.limits), *this) {
    renderer_ = std::make_unique<RenderThread>(config_, [this](Delivery&& delivery) { deliver(std::move(delivery)); });
    desk_.renderer = renderer_.get();
    desk_.loader = &loader_;
    if (!config_.assetDir.empty()) {
        desk_.assets = &assets_.emplace(config_.assetDir, config_.assetDirBytes, desk_.limits.assetBytes);
    }
    desk_.post = [this](std::function<void()> task) { server_.post(std::move(task)); };
    desk_.findSession = [this](std::string_view id) -> Viewer* {
        for (const auto& [key, viewer] : viewers_) {
            const session::Session* session = viewer->session();
            if (session && (session->id() == id || session::viewIdOf(session->id()) == id)) {
                return viewer.get();
            }
        }
        return nullptr;
    };
    desk_.eachViewer = [this](const std::function<void(Viewer&)>& visit) {
        for (const auto& [key, viewer] : viewers_) {
            visit(*viewer);
        }
    };
    desk_.find = [this](SessionKey key) {
        const auto viewer = viewers_.find(key);
        return viewer == viewers_.end() ? nullptr : viewer->second.get();
    };
    network_ = std::thread([this] { server_.run(); });
    log::info("ready").with("port", port()).with("gpu", renderer_->gpuName());
}

Service::~Service() {
    server_.post([this] { drain(); });
    network_.join();
    viewers_.clear();
    renderer_.reset();
}

void Service::opened(net::Connection& connection) {
    auto viewer = std::make_unique<Viewer>(desk_, connection);
    if (desk_.draining) {
        viewer->drain();
    }
    viewers_.emplace(connection.id(), std::move(viewer));
}

void Service::received(net::Connection& connection, std::string_view message, bool binary) {
    viewers_.at(connection.id())->received(message, binary);
}

std::optional<session::Outgoing> Service::next(net::Connection& connection) { return viewers_.at(connection.id())->next(); }

void Service::closed(net::Connection& connection) {
    const auto viewer = viewers_.find(connection.id());
    if (viewer == viewers_.end()) {
        return;
    }
    const session::Outbox& outbox = viewer->second->outbox();
    sentFrames_ += outbox.sent();
    sentBytes_ += outbox.sentBytes();
    dropped_ += outbox.dropped();
    log::info("closed").with("connection", connection.id()).with("frames", outbox.sent()).with("dropped", outbox.dropped());
    viewer->second->end();
    viewers_.erase(viewer);
    if (desk_.draining && viewers_.empty()) {
        server_.stop();
    }
}

void Service::tick() {
    const std::uint64_t now = session::nowUs();
    for (const auto& [key, viewer] : viewers_) {
        viewer->tick(now);
    }
    desk_.kept.sweep(now);
    desk_.scenes.trim();
    renderer_->collect();
    if (desk_.draining && now - drainSinceUs_ > kDrainUs) {
        server_.stop();
    }
}

void Service::deliver(Delivery&& delivery) {
    server_.post([this, carried = shared(std::move(delivery))] {
        if (Viewer* viewer = desk_.find(carried->job.session)) {
            viewer->deliver(std::move(*carried));
        }
    });
}

void Service::drain() {
    desk_.draining = true;
    drainSinceUs_ = session::nowUs();
    for (const auto& [key, viewer] : viewers_) {
        viewer->drain();
    }
    if (viewers_.empty()) {
        server_.stop();
    }
}

bool Service::healthy() const {
    const std::uint64_t busySince = renderer_->busySinceUs();
    return busySince == 0 || session::nowUs() - busySince < kStuckUs;
}

net::HttpResponse Service::http(const net::HttpRequest& request) {
    if (request.path == "/livez") {
        return {.body = "ok\n"};
    }
    if (request.path == "/readyz") {
        const bool free = !desk_.draining && desk_.sessions < desk_.limits.sessions;
        return {.status = free ? 200 : 503, .body = free ? "ready\n" : "no free session\n"};
    }
    if (request.path == "/healthz") {
        return desk_.draining ? net::HttpResponse{.status = 404, .body = "draining\n"}
               : healthy()    ? net::HttpResponse{.body = "ok\n"}
                              : net::HttpResponse{.status = 503, .body = "the renderer does not answer\n"};
    }
    if (request.path == "/metrics") {
        return {.contentType = "text/plain; version=0.0.4; charset=utf-8", .body = metrics()};
    }
    return net::pageFile(embedded::web(), request);
}

std::string Service::metrics() const {
    std::uint64_t frames = sentFrames_, bytes = sentBytes_, dropped = dropped_;
    for (const auto& [key, viewer] : viewers_) {
        frames += viewer->outbox().sent();
        bytes += viewer->outbox().sentBytes();
        dropped += viewer->outbox().dropped();
    }
    std::string gpu;
    for (const char c : renderer_->gpuName()) {
        gpu += (c == '"' || c == '\\') ? "\\" : "";
        gpu += c;
    }
    std::ostringstream text;
    const auto metric = [&](const char* name, const char* type, const char* help, auto value, const std::string& labels = "") {
        text << "# HELP caustream_" << name << ' ' << help << "\n# TYPE caustream_" << name << ' ' << type << "\ncaustream_"
             << name << labels << ' ' << value << '\n';
    };
    metric("gpu_info", "gauge", "The renderer in use.", 1, "{renderer=\"" + gpu + "\"}");
    metric("gl_objects", "gauge", "Textures, buffers, programs and the like that the renderer holds.", gl::liveObjects.load());
    metric("connections", "gauge", "Open WebSockets.", viewers_.size());
    metric("sessions", "gauge", "Viewers that said hello.", desk_.sessions);
    metric("frames_rendered_total", "counter", "Frames drawn.", renderer_->frames());
    metric("render_failures_total", "counter", "Frames the GPU refused.", renderer_->failures());
    metric("render_seconds_total", "counter", "Time spent drawing.", renderer_->renderMsTotal() * 1e-3);
    metric("frames_sent_total", "counter", "Frames handed to sockets.", frames);
    metric("frames_dropped_total", "counter", "Frames replaced before they left.", dropped);
    metric("sent_bytes_total", "counter", "Bytes of frames handed to sockets.", bytes);
    metric("refused_messages_total", "counter", "Messages answered with an error.", desk_.refusedMessages);
    return text.str();
}

}  // namespace caustream
