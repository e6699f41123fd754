// Whose turn it is on the GPU: sessions in turn, each with something new to show and room in its acknowledgement window.
// No change or no room: no work. The network thread tells it, the render thread asks; the clock is the caller's.
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>

#include "resolve_request.h"

namespace caustream {

using SessionKey = std::uint64_t;  // of the connection

// What one session shows, and since when.
struct Shown {
    std::shared_ptr<const View> view;
    std::uint32_t rev = 0, inputSeq = 0;
    std::uint64_t clientUs = 0;
    std::uint64_t changedUs = 0;  // server's clock
};

struct FrameJob {
    SessionKey session = 0;
    Shown shown;
    bool still = false;
    std::optional<std::uint32_t> requestId;
    std::uint64_t order = 0;      // rises with every job
    std::uint64_t startedUs = 0;
};

// Not synchronised: its owner holds a lock around every call.
class Scheduler {
   public:
    static constexpr std::uint64_t kStillAfterUs = 250'000;
    static constexpr std::size_t kMaxRequests = 4;  // frame.request, per session

    void add(SessionKey session) { entries_[session]; }
    void remove(SessionKey session) { entries_.erase(session); }

    void show(SessionKey session, Shown shown);
    void setStreaming(SessionKey session, bool streaming);

    // Frames that left or wait for the socket, and how many may.
    void setOccupied(SessionKey session, std::uint32_t frames, std::uint32_t window, std::uint64_t nowUs);

    // False when too many wait already.
    bool request(SessionKey session, std::uint32_t requestId, bool still);

    // The frame of `job` was handed to its connection, or will never be.
    void finished(const FrameJob& job);

    // True if something newer than `job` is to be shown.
    bool outdated(const FrameJob& job) const;

    // Everyone's picture is drawn anew: the shaders changed.
    void redrawAll();

    // The next frame to draw, what moves before what rests; nothing now: `wakeUs` is when to ask again, 0: when something
    // changes.
    std::optional<FrameJob> next(std::uint64_t nowUs, std::uint64_t& wakeUs);

   private:
    struct Request {
        Shown shown;
        std::uint32_t id = 0;
        bool still = false;
    };
    struct Entry {
        Shown shown;
        std::uint64_t version = 0, drawnVersion = 0;  // of `shown`; drawn: the last one given out
        bool streaming = false, stillDue = false;
        std::uint32_t occupied = 0, window = 1, drawing = 0;
        std::uint64_t notBeforeUs = 0;
        std::uint64_t quietSinceUs = 0;  // the last change, frame or acknowledgement: a slow frame is no idle time
        std::deque<Request> requests;
    };
    static bool hasRoom(const Entry& entry);
    std::optional<FrameJob> takeTurn(bool still, std::uint64_t nowUs, std::uint64_t& wakeUs);
    std::optional<FrameJob> takeMoving(SessionKey session, Entry& entry, std::uint64_t nowUs, std::uint64_t& wakeUs);
    std::optional<FrameJob> takeStill(SessionKey session, Entry& entry, std::uint64_t nowUs, std::uint64_t& wakeUs);
    FrameJob jobOf(SessionKey session, Entry& entry, bool still, std::uint64_t nowUs);

    std::map<SessionKey, Entry> entries_;
    SessionKey last_ = 0;
    std::uint64_t order_ = 0;
};

}  // namespace caustream
