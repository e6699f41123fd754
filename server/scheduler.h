// Whose turn it is on the GPU: sessions in turn, each with something new to show and room in its acknowledgement window.
// No change or no room: no work, but for what converges while it rests, which comes after everything else. The network
// thread tells it, the render thread asks; the clock is the caller's.
#pragma once
#include <array>
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
    bool converge = false;        // adds to a map and a picture that rest
    std::optional<std::uint32_t> requestId;
    std::uint64_t order = 0;      // rises with every job
    std::uint64_t startedUs = 0;

    // Drawn while nothing moves: worth nothing once something does.
    bool resting() const { return (still || converge) && !requestId; }

    // Whether this job's frame, drawn with such a map, is the last that its state needs: the map has converged, and of a
    // picture this is the anti-aliased still.
    bool endsConvergence(const std::optional<render::Convergence>& reached) const;
};

// Not synchronised: its owner holds a lock around every call.
class Scheduler {
   public:
    static constexpr std::uint64_t kStillAfterUs = 250'000;
    static constexpr std::uint64_t kConvergeAfterUs = 100'000;  // a hand that drags pauses for less
    static constexpr std::size_t kMaxRequests = 4;  // frame.request, per session

    void add(SessionKey session) { entries_[session]; }
    void remove(SessionKey session) { entries_.erase(session); }

    void show(SessionKey session, Shown shown);
    void setStreaming(SessionKey session, bool streaming);

    // Frames that left or wait for the socket, and how many may.
    void setOccupied(SessionKey session, std::uint32_t frames, std::uint32_t window, std::uint64_t nowUs);

    // False when too many wait already.
    bool request(SessionKey session, std::uint32_t requestId, bool still, bool converge = false);

    // The frame of `job` was drawn, its map being so far; nothing: it has no more to gain, or could not be drawn.
    void drawn(const FrameJob& job, const std::optional<render::Convergence>& reached);

    // The frame of `job` was handed to its connection, or will never be.
    void finished(const FrameJob& job);

    // True if something newer than `job` is to be shown.
    bool outdated(const FrameJob& job) const;

    // Everyone's picture is drawn anew: the shaders changed.
    void redrawAll();

    // The next frame to draw, what moves before stills before what converges; nothing now: `wakeUs` is when to ask again, 0: when something
    // changes.
    std::optional<FrameJob> next(std::uint64_t nowUs, std::uint64_t& wakeUs);

   private:
    struct Request {
        Shown shown;
        std::uint32_t id = 0;
        bool still = false, converge = false;
    };
    // Of what was drawn last. Reached: its last frame is still to come.
    enum class Convergence { None, UnderWay, Reached, Shown };
    struct Entry {
        Shown shown;
        std::uint64_t version = 0, drawnVersion = 0;  // of `shown`; drawn: the last one given out
        bool streaming = false, stillDue = false;
        Convergence convergence = Convergence::None;
        std::uint32_t occupied = 0, window = 1;
        std::uint32_t drawing = 0, drawingResting = 0;  // not yet with the connection; those that rest go if something moves
        std::uint64_t notBeforeUs = 0, notRestingBeforeUs = 0;
        std::uint64_t quietSinceUs = 0;  // the last change, frame or acknowledgement: a slow frame is no idle time
        std::deque<Request> requests;
    };
    using Take = std::optional<FrameJob> (Scheduler::*)(SessionKey, Entry&, std::uint64_t nowUs, std::uint64_t& wakeUs);
    std::optional<FrameJob> takeTurn(Take take, SessionKey& last, std::uint64_t nowUs, std::uint64_t& wakeUs);
    std::optional<FrameJob> takeMoving(SessionKey session, Entry& entry, std::uint64_t nowUs, std::uint64_t& wakeUs);
    std::optional<FrameJob> takeStill(SessionKey session, Entry& entry, std::uint64_t nowUs, std::uint64_t& wakeUs);
    std::optional<FrameJob> takeConverging(SessionKey session, Entry& entry, std::uint64_t nowUs, std::uint64_t& wakeUs);
    static void startAnew(Entry& entry);
    static bool rests(const Entry& entry);
    FrameJob jobOf(SessionKey session, Entry& entry, bool still, bool converge, std::uint64_t nowUs);

    std::map<SessionKey, Entry> entries_;
    std::array<SessionKey, 3> last_{};  // served: moving, still, converging; each kind takes turns of its own
    std::uint64_t order_ = 0;
};

}  // namespace caustream
