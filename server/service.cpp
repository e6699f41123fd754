#include "service.h"

#include <algorithm>
#include <utility>

#include "embedded/web.h"
#include "log.h"
#include "session/clock.h"
#include "session/random_id.h"

namespace caustream {
namespace {

constexpr int kEndS = 2;                              // for the viewers to take their leave where nobody drained before
constexpr std::uint64_t kNoticeUs = session::kUsPerS;          // for a load balancer's check to see that this server drains
constexpr std::uint64_t kRoundUs = 250'000;           // between the network thread's rounds
constexpr std::uint64_t kFarTooLateUs = 5 * session::kUsPerS;  // a round that late: connections time out meanwhile,
constexpr std::uint64_t kLagShownUs = 10 * session::kUsPerS;   // and this long health says so

net::ServerOptions serverOptions(const Config& config, const protocol::Limits& limits) {
    return {.bind = config.bind,
            .port = config.port,
            .maxTextBytes = limits.textBytes,
            .maxBinaryBytes = limits.binaryBytes,
            .pingS = static_cast<int>(limits.pingS),
            .deadS = static_cast<int>(limits.deadS),
            .tlsCert = config.tlsCert,
            .tlsKey = config.tlsKey,
            .allowedOrigins = config.allowedOrigins,
            .maxConnections = static_cast<std::size_t>(config.maxConnections),
            .maxPerAddress = static_cast<std::size_t>(config.maxPerAddress),
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
      desk_{.config = config_, .limits = limitsOf(config), .serverId = config.serverId.empty() ? session::randomId() : config.serverId},
      networkBeatUs_(session::nowUs()),
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
            if (session && session->isNamed(id)) {
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
    networkBeatUs_ = session::nowUs();
    network_ = std::thread([this] {
        server_.run();
        ended_ = true;
    });
    if (!config.bind.starts_with("127.") && config.tlsCert.empty()) {
        log::warning("bind").with("address", config.bind).with("message", "without TLS the token and the pictures go in the clear");
    }
    log::info("ready").with("port", port()).with("gpu", renderer_->gpuName());
}

Service::~Service() {
    drain(protocol::Goaway::Reason::Shutdown, kEndS);
    network_.join();
    viewers_.clear();
    renderer_.reset();
}

void Service::opened(net::Connection& connection) {
    auto viewer = std::make_unique<Viewer>(desk_, connection);
    if (desk_.draining) {
        viewer->drain(protocol::Goaway::Reason::Drain);
    }
    viewers_.emplace(connection.id(), std::move(viewer));
}

void Service::received(net::Connection& connection, std::string_view message, bool binary) {
    ++(binary ? desk_.counters.binaries : desk_.counters.texts);
    desk_.counters.receivedBytes += message.size();
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
    replaced_ += outbox.drops().replaced;
    outdated_ += outbox.drops().outdated;
    log::info("closed").with("connection", connection.id()).with("frames", outbox.sent()).with("dropped", outbox.dropped());
    viewer->second->end();
    viewers_.erase(viewer);
    if (desk_.draining && viewers_.empty()) {
        server_.stop();
    }
}

void Service::tick() {
    const std::uint64_t now = session::nowUs();
    const std::uint64_t late = now - std::min(now, networkBeatUs_.exchange(now) + kRoundUs);
    desk_.counters.loopLag.Observe(static_cast<double>(late) * 1e-6);
    if (late > kFarTooLateUs) {
        laggedUs_ = now;
        log::warning("lag").with("ms", late / 1000);
    }
    for (const auto& [key, viewer] : viewers_) {
        viewer->tick(now);
    }
    desk_.kept.sweep(now);
    desk_.scenes.trim();
    renderer_->collect();
    if (!desk_.draining) {
        return;
    }
    if (now > farewellUs_) {
        sayFarewell(protocol::Goaway::Reason::Drain);
    }
    if (now > endUs_ || viewers_.empty()) {
        server_.stop();
    } else if (now + kEndS * session::kUsPerS > endUs_) {
        for (const auto& [key, viewer] : viewers_) {
            viewer->leave();
        }
    }
}

void Service::deliver(Delivery&& delivery) {
    if (delivery.error.empty()) {
        desk_.counters.render.Observe(delivery.frame.header.renderUs * 1e-6);
        desk_.counters.encode.Observe(delivery.frame.header.encodeUs * 1e-6);
    }
    server_.post([this, carried = shared(std::move(delivery))] {
        if (Viewer* viewer = desk_.find(carried->job.session)) {
            viewer->deliver(std::move(*carried));
        }
    });
}

void Service::drain(protocol::Goaway::Reason reason, int seconds) {
    if (!draining_.exchange(true)) {
        server_.post([this, reason, seconds] { startDraining(reason, seconds); });
    }
}

void Service::startDraining(protocol::Goaway::Reason reason, int seconds) {
    desk_.draining = true;
    endUs_ = session::nowUs() + static_cast<std::uint64_t>(seconds) * session::kUsPerS;
    log::info("draining").with("viewers", viewers_.size()).with("seconds", seconds);
    if (viewers_.empty()) {
        server_.stop();
    } else if (reason == protocol::Goaway::Reason::Drain) {
        farewellUs_ = session::nowUs() + kNoticeUs;  // frames go on until then
    } else {
        sayFarewell(reason);
    }
}

void Service::sayFarewell(protocol::Goaway::Reason reason) {
    farewellUs_ = ~std::uint64_t{0};
    for (const auto& [key, viewer] : viewers_) {
        viewer->drain(reason);
    }
}

std::optional<std::string> Service::failure() const {
    const std::uint64_t now = session::nowUs(), most = static_cast<std::uint64_t>(config_.watchdogS) * session::kUsPerS;
    const auto tooLong = [&](std::uint64_t sinceUs) { return now > sinceUs && now - sinceUs > most; };
    if (const char* lost = renderer_->lost()) {
        return lost;
    }
    if (const std::uint64_t busySince = renderer_->busySinceUs(); busySince != 0 && tooLong(busySince)) {
        return "one frame has taken longer than " + std::to_string(config_.watchdogS) + " s";
    }
    if (tooLong(networkBeatUs_) && !ended_) {
        return "the network thread has stood still for " + std::to_string(config_.watchdogS) + " s";
    }
    return std::nullopt;
}

void Service::fail(const std::string& why) {
    log::error("failed").with("message", why);
    failed_ = true;
    server_.post([this, why] { tellFailure(why); });
}

void Service::tellFailure(const std::string& why) {
    const bool lost = renderer_->lost();
    for (const auto& [key, viewer] : viewers_) {
        viewer->say({protocol::Status::Level::Error, "gpu", why + "; the server ends, another may take over"});
        if (lost) {
            viewer->fail({.code = protocol::ErrorCode::GpuError, .message = why});
        }
    }
}

net::HttpResponse Service::health() const {
    if (failed_) {
        return {.status = 503, .body = "failed\n"};
    }
    if (const auto why = failure()) {
        return {.status = 503, .body = *why + "\n"};
    }
    if (laggedUs_ != 0 && session::nowUs() - laggedUs_ < kLagShownUs) {
        return {.status = 503, .body = "the network thread is late\n"};
    }
    return draining_ ? net::HttpResponse{.status = 404, .body = "draining\n"} : net::HttpResponse{.body = "ok\n"};
}

net::HttpResponse Service::http(const net::HttpRequest& request) {
    if (request.path == "/livez") {
        return {.body = "ok\n"};
    }
    if (request.path == "/readyz") {
        const bool free = !draining_ && !failed_ && desk_.sessions < desk_.limits.sessions;
        return {.status = free ? 200 : 503, .body = free ? "ready\n" : "no free session\n"};
    }
    if (request.path == "/healthz") {
        return health();
    }
    if (request.path == "/metrics") {
        return {.contentType = "text/plain; version=0.0.4; charset=utf-8", .body = metrics()};
    }
    return net::pageFile(embedded::web(), request);
}

}  // namespace caustream
