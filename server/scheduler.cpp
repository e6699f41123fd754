#include "scheduler.h"

#include <utility>

namespace caustream {
namespace {

void noteWake(std::uint64_t& wakeUs, std::uint64_t candidateUs) {
    wakeUs = wakeUs == 0 || candidateUs < wakeUs ? candidateUs : wakeUs;
}

// Anti-aliasing makes a picture better; the spectral map has none.
bool wantsStill(const Shown& shown) { return shown.view && shown.view->request.target == render::Target::Composite; }

}  // namespace

bool Scheduler::hasRoom(const Entry& entry) {
    return entry.streaming && entry.shown.view && entry.occupied + entry.drawing < entry.window;
}

void Scheduler::show(SessionKey session, Shown shown) {
    Entry& entry = entries_.at(session);
    entry.shown = std::move(shown);
    ++entry.version;
    entry.quietSinceUs = entry.shown.changedUs;
    entry.stillDue = wantsStill(entry.shown);
}

void Scheduler::setStreaming(SessionKey session, bool streaming) {
    Entry& entry = entries_.at(session);
    if (streaming && !entry.streaming) {
        entry.drawnVersion = 0;  // whoever starts has nothing to look at yet
        entry.stillDue = wantsStill(entry.shown);
    }
    entry.streaming = streaming;
}

void Scheduler::setOccupied(SessionKey session, std::uint32_t frames, std::uint32_t window, std::uint64_t nowUs) {
    Entry& entry = entries_.at(session);
    entry.occupied = frames;
    entry.window = window;
    entry.quietSinceUs = nowUs;
}

bool Scheduler::request(SessionKey session, std::uint32_t requestId, bool still) {
    Entry& entry = entries_.at(session);
    if (entry.requests.size() >= kMaxRequests) {
        return false;
    }
    entry.requests.push_back({entry.shown, requestId, still});
    return true;
}

void Scheduler::finished(const FrameJob& job) {
    const auto entry = entries_.find(job.session);
    if (entry != entries_.end() && !job.requestId) {
        --entry->second.drawing;
    }
}

bool Scheduler::outdated(const FrameJob& job) const {
    const auto entry = entries_.find(job.session);
    return entry == entries_.end() || entry->second.shown.view != job.shown.view;
}

void Scheduler::redrawAll() {
    for (auto& [session, entry] : entries_) {
        entry.drawnVersion = 0;
        entry.stillDue = wantsStill(entry.shown);
    }
}

std::optional<FrameJob> Scheduler::next(std::uint64_t nowUs, std::uint64_t& wakeUs) {
    wakeUs = 0;
    auto job = takeTurn(false, nowUs, wakeUs);
    return job ? job : takeTurn(true, nowUs, wakeUs);
}

std::optional<FrameJob> Scheduler::takeTurn(bool still, std::uint64_t nowUs, std::uint64_t& wakeUs) {
    // From the one after the last served, around.
    auto at = entries_.upper_bound(last_);
    for (std::size_t i = 0; i < entries_.size(); ++i, ++at) {
        if (at == entries_.end()) {
            at = entries_.begin();
        }
        auto job = still ? takeStill(at->first, at->second, nowUs, wakeUs) : takeMoving(at->first, at->second, nowUs, wakeUs);
        if (job) {
            last_ = at->first;
            return job;
        }
    }
    return std::nullopt;
}

FrameJob Scheduler::jobOf(SessionKey session, Entry& entry, bool still, std::uint64_t nowUs) {
    ++entry.drawing;
    return {.session = session, .shown = entry.shown, .still = still, .order = ++order_, .startedUs = nowUs};
}

std::optional<FrameJob> Scheduler::takeMoving(SessionKey session, Entry& entry, std::uint64_t nowUs, std::uint64_t& wakeUs) {
    if (!entry.requests.empty()) {
        Request request = std::move(entry.requests.front());
        entry.requests.pop_front();
        return FrameJob{.session = session,
                        .shown = std::move(request.shown),
                        .still = request.still,
                        .requestId = request.id,
                        .order = ++order_,
                        .startedUs = nowUs};
    }
    if (!hasRoom(entry) || entry.version == entry.drawnVersion) {
        return std::nullopt;
    }
    if (nowUs < entry.notBeforeUs) {
        noteWake(wakeUs, entry.notBeforeUs);
        return std::nullopt;
    }
    entry.drawnVersion = entry.version;
    entry.notBeforeUs = nowUs + static_cast<std::uint64_t>(1e6 / entry.shown.view->stream.maxFps);
    return jobOf(session, entry, false, nowUs);
}

std::optional<FrameJob> Scheduler::takeStill(SessionKey session, Entry& entry, std::uint64_t nowUs, std::uint64_t& wakeUs) {
    if (!hasRoom(entry) || !entry.stillDue || entry.drawing > 0 || entry.version != entry.drawnVersion) {
        return std::nullopt;
    }
    const std::uint64_t dueUs = entry.quietSinceUs + kStillAfterUs;
    if (nowUs < dueUs) {
        noteWake(wakeUs, dueUs);
        return std::nullopt;
    }
    entry.stillDue = false;
    return jobOf(session, entry, true, nowUs);
}

}  // namespace caustream
