#include "scheduler.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace caustream {
namespace {

void noteWake(std::uint64_t& wakeUs, std::uint64_t candidateUs) {
    wakeUs = wakeUs == 0 || candidateUs < wakeUs ? candidateUs : wakeUs;
}

// Anti-aliasing makes a picture better; the spectral map has none.
bool wantsStill(const Shown& shown) { return shown.view && shown.view->request.target == render::Target::Composite; }

// Whoever waits gets the picture without JPEG's losses, where its program reads such.
bool wantsLossless(const Shown& shown) {
    return wantsStill(shown) && shown.view->losslessFollows();
}

// Between two frames at the most that are wanted a second.
std::uint64_t frameUs(const Shown& shown) { return static_cast<std::uint64_t>(1e6 / shown.view->stream.maxFps); }

}  // namespace

bool FrameJob::mayEndConvergence() const { return resting() && converge && (still || !wantsStill(shown)); }

bool FrameJob::endsConvergence(const std::optional<render::Convergence>& reached) const {
    return mayEndConvergence() && reached && reached->converged;
}

// What was drawn before is no more.
void Scheduler::startAnew(Entry& entry) {
    entry.stillDue = wantsStill(entry.shown);
    entry.losslessDue = wantsLossless(entry.shown);
    entry.convergence = Convergence::None;
}

// All that was to be shown was drawn, and there is room for more of it.
bool Scheduler::rests(const Entry& entry) {
    return entry.streaming && entry.shown.view && entry.version == entry.drawnVersion && entry.drawing == 0 &&
           entry.occupied + entry.drawingResting < entry.window;
}

void Scheduler::show(SessionKey session, Shown shown) {
    Entry& entry = entries_.at(session);
    entry.shown = std::move(shown);
    ++entry.version;
    entry.quietSinceUs = entry.shown.changedUs;
    startAnew(entry);
}

void Scheduler::setStreaming(SessionKey session, bool streaming) {
    Entry& entry = entries_.at(session);
    if (streaming && !entry.streaming) {
        entry.drawnVersion = 0;  // whoever starts has nothing to look at yet
        startAnew(entry);
    }
    entry.streaming = streaming;
}

void Scheduler::setOccupied(SessionKey session, std::uint32_t frames, std::uint32_t window, std::uint64_t nowUs) {
    Entry& entry = entries_.at(session);
    entry.occupied = frames;
    entry.window = window;
    entry.quietSinceUs = nowUs;
}

tl::expected<void, Scheduler::Busy> Scheduler::request(SessionKey session, std::uint32_t requestId, bool still, bool converge,
                                                       std::uint64_t nowUs) {
    Entry& entry = entries_.at(session);
    std::uint64_t affordedUs = 0;
    if (!affords(entry, nowUs, affordedUs)) {
        return tl::unexpected(Busy{static_cast<std::uint32_t>((affordedUs - nowUs) / 1000 + 1)});
    }
    if (entry.requests.size() >= kMaxRequests) {
        return tl::unexpected(Busy{});
    }
    entry.requests.push_back({entry.shown, requestId, still, converge});
    return {};
}

void Scheduler::spent(SessionKey session, std::uint64_t us) {
    if (const auto entry = entries_.find(session); entry != entries_.end()) {
        entry->second.servedUs += us;
        entry->second.leftUs -= static_cast<double>(us);
    }
}

// False while the session's share of the second is used up; `wakeUs` learns when it is not.
bool Scheduler::affords(Entry& entry, std::uint64_t nowUs, std::uint64_t& wakeUs) const {
    if (gpuMsPerS_ == 0) {
        return true;
    }
    const double perUs = 1e-3 * gpuMsPerS_, most = 1e3 * gpuMsPerS_;
    const double earned = entry.leftAtUs == 0 ? most : perUs * static_cast<double>(nowUs - entry.leftAtUs);
    entry.leftUs = std::min(most, entry.leftUs + earned);
    entry.leftAtUs = nowUs;
    if (entry.leftUs <= 0.0) {
        noteWake(wakeUs, nowUs + 1 + static_cast<std::uint64_t>(-entry.leftUs / perUs));
    }
    return entry.leftUs > 0.0;
}

void Scheduler::drawn(const FrameJob& job, const std::optional<render::Convergence>& reached) {
    if (job.requestId || outdated(job)) {
        return;  // it says nothing of what the stream shows
    }
    Entry& entry = entries_.at(job.session);
    entry.convergence = !reached                    ? Convergence::None
                        : !reached->converged       ? Convergence::UnderWay
                        : job.endsConvergence(reached) ? Convergence::Shown
                                                    : Convergence::Reached;
    entry.stillDue = entry.stillDue && !reached;
    entry.losslessDue = entry.losslessDue && !reached;
}

void Scheduler::finished(const FrameJob& job) {
    const auto entry = entries_.find(job.session);
    if (entry != entries_.end() && !job.requestId) {
        --(job.resting() ? entry->second.drawingResting : entry->second.drawing);
    }
}

bool Scheduler::outdated(const FrameJob& job) const {
    const auto entry = entries_.find(job.session);
    return entry == entries_.end() || entry->second.shown.view != job.shown.view;
}

std::vector<SessionKey> Scheduler::sessions() const {
    std::vector<SessionKey> sessions;
    for (const auto& [session, entry] : entries_) {
        sessions.push_back(session);
    }
    return sessions;
}

std::vector<const scene::Geometry*> Scheduler::geometryShown() const {
    std::vector<const scene::Geometry*> shown;
    const auto add = [&](const Shown& one) {
        if (one.view) {
            shown.push_back(one.view->request.scene->geometry.get());
        }
    };
    for (const auto& [session, entry] : entries_) {
        add(entry.shown);
        for (const Request& request : entry.requests) {
            add(request.shown);
        }
    }
    return shown;
}

void Scheduler::redrawAll() {
    for (auto& [session, entry] : entries_) {
        entry.drawnVersion = 0;
        startAnew(entry);
    }
}

std::optional<FrameJob> Scheduler::next(std::uint64_t nowUs, std::uint64_t& wakeUs) {
    wakeUs = 0;
    constexpr std::array<Take, 3> kByUrgency = {&Scheduler::takeMoving, &Scheduler::takeStill, &Scheduler::takeConverging};
    for (const bool starvedOnly : {true, false}) {
        for (const Take take : kByUrgency) {
            if (auto job = takeTurn(take, starvedOnly, nowUs, wakeUs)) {
                return job;
            }
        }
    }
    return std::nullopt;
}

// On the common scale: whoever had nothing to draw for long has no claim to all that the others got meanwhile.
std::uint64_t Scheduler::startOf(const Entry& entry) const {
    return std::max(entry.servedUs, clock_ - std::min(clock_, kCreditUs));
}

std::optional<FrameJob> Scheduler::takeTurn(Take take, bool starvedOnly, std::uint64_t nowUs, std::uint64_t& wakeUs) {
    std::vector<std::pair<std::uint64_t, SessionKey>> order;
    for (const auto& [session, entry] : entries_) {
        if (!starvedOnly || clock_ > entry.servedUs + kStarvedUs) {
            order.emplace_back(startOf(entry), session);
        }
    }
    std::ranges::sort(order);
    for (const auto& [startUs, session] : order) {
        Entry& entry = entries_.at(session);
        if (!affords(entry, nowUs, wakeUs)) {
            continue;
        }
        if (auto job = (this->*take)(session, entry, nowUs, wakeUs)) {
            clock_ = std::max(clock_, startUs);
            entry.servedUs = startUs + 1;  // equals take turns even where nothing is measured
            return job;
        }
    }
    return std::nullopt;
}

FrameJob Scheduler::jobOf(SessionKey session, Entry& entry, bool still, bool converge, std::uint64_t nowUs) {
    FrameJob job{.session = session, .shown = entry.shown, .still = still, .converge = converge, .order = ++order_, .startedUs = nowUs};
    ++(job.resting() ? entry.drawingResting : entry.drawing);
    return job;
}

std::optional<FrameJob> Scheduler::takeMoving(SessionKey session, Entry& entry, std::uint64_t nowUs, std::uint64_t& wakeUs) {
    if (!entry.requests.empty()) {
        Request request = std::move(entry.requests.front());
        entry.requests.pop_front();
        return FrameJob{.session = session,
                        .shown = std::move(request.shown),
                        .still = request.still,
                        .converge = request.converge,
                        .requestId = request.id,
                        .order = ++order_,
                        .startedUs = nowUs};
    }
    // A resting frame that is being drawn takes no room: it is thrown away, as it shows what is no more.
    const bool room = entry.streaming && entry.shown.view && entry.occupied + entry.drawing < entry.window;
    if (!room || entry.version == entry.drawnVersion) {
        return std::nullopt;
    }
    if (nowUs < entry.notBeforeUs) {
        noteWake(wakeUs, entry.notBeforeUs);
        return std::nullopt;
    }
    entry.drawnVersion = entry.version;
    entry.notBeforeUs = nowUs + frameUs(entry.shown);
    FrameJob job = jobOf(session, entry, false, false, nowUs);
    job.level = entry.shown.view->adaptive ? entry.level : stream::Ladder::kFixed;
    return job;
}

std::optional<FrameJob> Scheduler::takeStill(SessionKey session, Entry& entry, std::uint64_t nowUs, std::uint64_t& wakeUs) {
    if (!rests(entry) || !(entry.stillDue || entry.losslessDue)) {
        return std::nullopt;
    }
    const bool lossless = !entry.stillDue;
    const std::uint64_t dueUs = std::max(entry.quietSinceUs + kStillAfterUs, lossless ? entry.shown.changedUs + kLosslessAfterUs : 0);
    if (nowUs < dueUs) {
        noteWake(wakeUs, dueUs);
        return std::nullopt;
    }
    (lossless ? entry.losslessDue : entry.stillDue) = false;
    FrameJob job = jobOf(session, entry, true, false, nowUs);
    job.lossless = lossless;
    return job;
}

std::optional<FrameJob> Scheduler::takeConverging(SessionKey session, Entry& entry, std::uint64_t nowUs, std::uint64_t& wakeUs) {
    const bool last = entry.convergence == Convergence::Reached;
    if (!rests(entry) || (!last && entry.convergence != Convergence::UnderWay)) {
        return std::nullopt;
    }
    const std::uint64_t dueUs = std::max({entry.shown.changedUs + kConvergeAfterUs, entry.notBeforeUs, entry.notRestingBeforeUs});
    if (nowUs < dueUs) {
        noteWake(wakeUs, dueUs);
        return std::nullopt;
    }
    // Of its own: what moves next need not wait for it.
    entry.notRestingBeforeUs = nowUs + frameUs(entry.shown);
    if (last) {
        entry.convergence = Convergence::Shown;
    }
    return jobOf(session, entry, last && wantsStill(entry.shown), true, nowUs);
}

}  // namespace caustream
