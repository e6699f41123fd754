#include "viewer.h"

#include <algorithm>
#include <utility>

#include "log.h"
#include "optics/dispersion.h"
#include "render/pipeline.h"
#include "scene/builtin_scenes.h"
#include "session/clock.h"
#include "session/random_id.h"
#include "session/scene_overrides.h"
#include "session/scene_summary.h"

namespace caustream {
namespace {

using protocol::CloseCode;
using protocol::DecodeError;
using protocol::ErrorCode;

constexpr std::uint64_t kStatsEveryUs = session::kUsPerS, kConvergingStatsEveryUs = session::kUsPerS / 5;
constexpr std::uint32_t kRetryMs = 2000;
constexpr std::uint32_t kReconnectMs = 50, kJitterMs = 450; // so that the next server is not met by all at once
constexpr double kChunksPerS = 2000;                        // credit bounds the bytes, this the smallest of chunks
constexpr std::size_t kMaxDeferredBytes = 4u << 20;         // while a scene loads
constexpr std::size_t kMaxWaitingTextBytes = 16u << 20;     // for a client that talks and does not read

}  // namespace

Viewer::Viewer(Desk& desk, net::Connection& connection)
    : desk_(desk),
      connection_(connection),
      texts_(desk.limits.messagesPerS),
      chunks_(kChunksPerS),
      openedUs_(session::nowUs()),
      heardUs_(openedUs_) {}

Viewer::~Viewer() {
    desk_.loader->end(connection_.id());
    if (session_) {
        --desk_.sessions;
    }
    if (ready_) {
        desk_.renderer->schedule([this](Scheduler& scheduler) { scheduler.remove(connection_.id()); });
        desk_.renderer->collect();
    }
}

void Viewer::received(std::string_view message, bool binary) {
    if (!(binary ? chunks_ : texts_).take(session::nowUs())) {
        fail(problem(ErrorCode::RateLimited, "more than " + std::to_string(desk_.limits.messagesPerS) + " messages a second"));
    } else if (!loading_) {
        handle(message, binary);
    } else if ((deferredBytes_ += message.size()) > kMaxDeferredBytes) {
        fail(problem(ErrorCode::TooLarge, "too much was sent while a scene loads"));
    } else {
        deferred_.emplace_back(message, binary);
    }
}

void Viewer::handle(std::string_view message, bool binary) {
    if (binary) {
        chunk(message);
        return;
    }
    const auto decoded = protocol::decodeClientMessage(message, desk_.limits, session_ && session_->strict());
    if (!decoded) {
        refuse(decoded.error());
    } else if (!ready_ && !std::holds_alternative<protocol::Hello>(*decoded)) {
        refuse(problem(ErrorCode::BadRequest, "the first message is hello", "op"));
    } else {
        if (!std::holds_alternative<protocol::Ack>(*decoded) && !std::holds_alternative<protocol::Ping>(*decoded)) {
            rest(heardUs_ = session::nowUs());
        }
        std::visit([this](const auto& known) { on(known); }, *decoded);
    }
}

// A stream that no one has spoken to for long rests, until someone does; a connection that stays silent ends.
void Viewer::rest(std::uint64_t nowUs) {
    const std::uint64_t silentUs = nowUs - heardUs_;
    if (const bool idle = silentUs > desk_.limits.idlePauseS * session::kUsPerS; ready_ && idle != idle_) {
        idle_ = idle;
        send(protocol::Status{protocol::Status::Level::Info, "idle", idle ? "nothing was said for long: the stream rests until something is" : ""});
        desk_.renderer->schedule([&](Scheduler& scheduler) { scheduler.setStreaming(connection_.id(), streaming_ && !idle); });
    }
    if (silentUs > desk_.limits.idleCloseS * session::kUsPerS) {
        fail(problem(ErrorCode::Timeout, "nothing was said for " + std::to_string(desk_.limits.idleCloseS) + " s"));
    }
}

void Viewer::on(const protocol::Update& update) {
    if (!mayPatch(update.patch, update.id)) {
        return;
    }
    change({.patch = update.patch, .done = [this, id = update.id](const std::optional<DecodeError>& error) {
                if (error) {
                    DecodeError reply = *error;
                    reply.id = id;
                    refuse(reply);
                } else if (id) {
                    ok(*id);
                }
            }});
}

void Viewer::on(const protocol::Input& input) {
    if (!mayPatch(input.patch, {})) {
        return;
    }
    change({.patch = input.patch, .input = input, .done = [this](const std::optional<DecodeError>& error) {
                if (error) {
                    refuse(*error);
                }
            }});
}

void Viewer::on(const protocol::StreamStart& start) {
    wantsStats_ = start.stats;
    setStreaming(start.id, true);
}

void Viewer::on(const protocol::StreamPause& pause) { setStreaming(pause.id, false); }

void Viewer::on(const protocol::StreamResume& resume) { setStreaming(resume.id, true); }

void Viewer::setStreaming(std::uint32_t id, bool streaming) {
    streaming_ = streaming;
    ok(id);
    desk_.renderer->schedule([&](Scheduler& scheduler) { scheduler.setStreaming(connection_.id(), streaming); });
}

void Viewer::on(const protocol::FrameRequest& request) {
    const bool room = requestsPending_ + outbox_.answersWaiting() < Scheduler::kMaxRequests;
    const auto taken = !room ? tl::unexpected(Scheduler::Busy{}) : desk_.renderer->schedule([&](Scheduler& scheduler) {
        return scheduler.request(connection_.id(), request.id, request.still, request.converge, session::nowUs());
    });
    if (taken) {
        ++requestsPending_;
        noteRequest(request);
    } else if (taken.error().retryMs > 0) {
        refuse(problem(ErrorCode::Busy, "this viewer's " + std::to_string(desk_.limits.gpuMsPerS) + " ms of GPU time a second are used up", {}, request.id),
               taken.error().retryMs);
    } else {
        refuse(problem(ErrorCode::Busy, std::to_string(Scheduler::kMaxRequests) + " frames are asked for already", {}, request.id));
    }
}

void Viewer::on(const protocol::Ack& ack) {
    const std::uint32_t onTheWay = outbox_.unacknowledged();
    if (!outbox_.acknowledge(ack, session::nowUs())) {
        refuse(problem(ErrorCode::OutOfRange, "no frame of this number was sent", "seq"));
        return;
    }
    if (outbox_.unacknowledged() < onTheWay) {
        texts_.giveBack();
        if (outbox_.ageMs() > 0.0) {
            desk_.counters.frameAge.Observe(outbox_.ageMs() * 1e-3);
        }
    }
    updateOccupied();
    connection_.requestWrite();
    endIfIdle();
}

void Viewer::on(const protocol::Ping& ping) { send(protocol::Pong{ping.tUs, session::nowUs()}); }

std::optional<session::Outgoing> Viewer::next() {
    std::optional<session::Outgoing> message = outbox_.next(session::nowUs());
    if (message && message->binary) {
        updateOccupied();
        sendStats(session::nowUs());
    }
    return message;
}

void Viewer::updateOccupied() {
    if (!ready_) {
        return;
    }
    desk_.renderer->schedule([this](Scheduler& scheduler) { tell(scheduler); });
}

// How much room there is, and what the link carries.
void Viewer::tell(Scheduler& scheduler) const {
    scheduler.setOccupied(connection_.id(), outbox_.occupied(), outbox_.window(), session::nowUs());
    scheduler.setLevel(connection_.id(), outbox_.level());
}

void Viewer::deliver(Delivery&& delivery) {
    if (!ready_) {
        return;  // its session has gone to another connection
    }
    const FrameJob& job = delivery.job;
    bool stale = false;
    if (job.requestId) {
        --requestsPending_;
    }
    if (!delivery.error.empty()) {
        refuse(problem(ErrorCode::GpuError, delivery.error, {}, job.requestId));
    } else if (job.requestId) {
        noteAnswer(*job.requestId, delivery.frame);
        outbox_.requested(std::move(delivery.frame));
    } else {
        stale = job.resting() && desk_.renderer->schedule([&](Scheduler& scheduler) { return scheduler.outdated(job); });
        if (stale) {
            outbox_.countOutdated();
        } else {
            outbox_.streamed(job.order, std::move(delivery.frame));
        }
    }
    desk_.renderer->schedule([&](Scheduler& scheduler) {
        scheduler.finished(job);
        tell(scheduler);
    });
    connection_.requestWrite();
}

void Viewer::tick(std::uint64_t nowUs) {
    if (connection_.closing()) {
        return;
    }
    if (!session_ && nowUs - openedUs_ > desk_.limits.helloS * session::kUsPerS) {
        fail(problem(ErrorCode::Timeout, "no hello in " + std::to_string(desk_.limits.helloS) + " s"));
        return;
    }
    const auto waitingSince = outbox_.waitingSinceUs();
    if (waitingSince && nowUs - *waitingSince > desk_.limits.deadS * session::kUsPerS) {
        fail(problem(ErrorCode::Timeout, "no acknowledgement in " + std::to_string(desk_.limits.deadS) + " s"));
        return;
    }
    if (outbox_.textBytes() > kMaxWaitingTextBytes) {
        fail(problem(ErrorCode::RateLimited, "replies are not read"));
        return;
    }
    if (std::exchange(toldLate_, false)) {
        sendState();
    }
    rest(nowUs);
    sendStats(nowUs);
    endIfIdle();
}

// What waits for a picture to converge wants to see it come nearer, and that it is there.
void Viewer::sendStats(std::uint64_t nowUs) {
    const auto& newest = outbox_.newestStats();
    if (!wantsStats_ || !newest) {
        return;
    }
    const std::uint64_t everyUs = newest->convergence ? kConvergingStatsEveryUs : kStatsEveryUs;
    if (outbox_.newestConverged() || nowUs - statsSentUs_ >= everyUs) {
        statsSentUs_ = nowUs;
        send(*outbox_.takeStats());
    }
}

void Viewer::drain(protocol::Goaway::Reason reason) {
    if (connection_.closing()) {
        return;
    }
    draining_ = true;
    send(protocol::Goaway{reason, kReconnectMs, kJitterMs});
    if (ready_) {
        desk_.renderer->schedule([this](Scheduler& scheduler) { scheduler.setStreaming(connection_.id(), false); });
    }
    endIfIdle();
}

void Viewer::endIfIdle() {
    if (draining_ && !loading_ && requestsPending_ == 0 && outbox_.answersWaiting() == 0 && outbox_.occupied() == 0) {
        leave();
    }
}

void Viewer::leave() { connection_.close(static_cast<std::uint16_t>(CloseCode::GoingAway), "the server ends"); }

void Viewer::ok(std::uint32_t id) {
    protocol::Ok message{.id = id};
    message.rev = session_->rev();
    send(message);
}

void Viewer::refuse(const DecodeError& error, std::optional<std::uint32_t> retryMs) {
    ++desk_.counters.errors[error.code];
    protocol::ErrorMessage message = protocol::errorMessage(error);
    message.retryMs = retryMs;
    send(message);
}

void Viewer::fail(const DecodeError& error) {
    ++desk_.counters.errors[error.code];
    protocol::ErrorMessage message = protocol::errorMessage(error, true);
    if (error.code == ErrorCode::Busy || error.code == ErrorCode::RateLimited) {
        message.retryMs = kRetryMs;
    }
    send(message);
    const auto code = protocol::closeCodeOf(error.code).value_or(CloseCode::BadMessage);
    connection_.close(static_cast<std::uint16_t>(code), error.message);
}

}  // namespace caustream
