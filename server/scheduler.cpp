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

std::optional<FrameJob> Scheduler::next(std::uint64_t nowUs, std::uint64_t& wakeUs) {
    wakeUs = 0;
    // From the one after the last served, around.
    auto at = entries_.upper_bound(last_);
    for (std::size_t i = 0; i < entries_.size(); ++i, ++at) {
        if (at == entries_.end()) {
            at = entries_.begin();
        }
        if (auto job = take(at->first, at->second, nowUs, wakeUs)) {
            last_ = at->first;
            return job;
        }
    }
    return std::nullopt;
}

std::optional<FrameJob> Scheduler::take(SessionKey session, Entry& entry, std::uint64_t nowUs, std::uint64_t& wakeUs) {
    FrameJob job{.session = session, .order = order_ + 1, .startedUs = nowUs};
    if (!entry.requests.empty()) {
        Request& request = entry.requests.front();
        job.shown = std::move(request.shown);
        job.still = request.still;
        job.requestId = request.id;
        entry.requests.pop_front();
        ++order_;
        return job;
    }
    if (!entry.streaming || !entry.shown.view || entry.occupied + entry.drawing >= entry.window) {
        return std::nullopt;
    }
    if (entry.version != entry.drawnVersion) {
        if (nowUs < entry.notBeforeUs) {
            noteWake(wakeUs, entry.notBeforeUs);
            return std::nullopt;
        }
        entry.drawnVersion = entry.version;
        entry.notBeforeUs = nowUs + static_cast<std::uint64_t>(1e6 / entry.shown.view->stream.maxFps);
    } else if (entry.stillDue && entry.drawing == 0) {
        const std::uint64_t dueUs = entry.quietSinceUs + kStillAfterUs;
        if (nowUs < dueUs) {
            noteWake(wakeUs, dueUs);
            return std::nullopt;
        }
        entry.stillDue = false;
        job.still = true;
    } else {
        return std::nullopt;
    }
    job.shown = entry.shown;
    ++entry.drawing;
    ++order_;
    return job;
}

}  // namespace caustream
