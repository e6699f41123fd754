// Whose turn it is on the GPU: of the sessions with something new to show and room in their acknowledgement windows, the one
// that has had the least of it (start-time fair queueing, Goyal, Vin & Cheng 1996, by measured time). No change or no room:
// no work, but for what converges while it rests, which comes after everything else. The network thread tells it, the
// render thread asks; the clock is the caller's.
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "resolve_request.h"
#include "stream/ladder.h"

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
    bool lossless = false;        // the still is sent again, without loss
    bool converge = false;        // adds to a map and a picture that rest
    int level = stream::Ladder::kFixed;  // of the quality ladder, where the view follows it
    std::optional<std::uint32_t> requestId;
    std::uint64_t order = 0;      // rises with every job
    std::uint64_t startedUs = 0;

    // Drawn while nothing moves: worth nothing once something does.
    bool resting() const { return (still || converge) && !requestId; }

    // Whether it may be what the next one asks for: known before it is drawn.
    bool mayEndConvergence() const;

    // Whether this job's frame, drawn with such a map, is the last that its state needs: the map has converged, and of a
    // picture this is the anti-aliased still.
    bool endsConvergence(const std::optional<render::Convergence>& reached) const;
};

// Not synchronised: its owner holds a lock around every call.
class Scheduler {
   public:
    static constexpr std::uint64_t kStillAfterUs = 250'000;
    static constexpr std::uint64_t kLosslessAfterUs = 1'000'000;
    static constexpr std::uint64_t kConvergeAfterUs = 100'000;  // a hand that drags pauses for less
    static constexpr std::size_t kMaxRequests = 4;  // frame.request, per session
    static constexpr std::uint64_t kCreditUs = 100'000;   // GPU time that whoever did nothing for long may catch up
    static constexpr std::uint64_t kStarvedUs = 500'000;  // GPU time of others after which what rests goes before what moves

    struct Busy {
        std::uint32_t retryMs = 0;  // 0: as soon as an answer has come
    };

    // `gpuMsPerS`: of each second, the most that one session gets; 0: no limit.
    explicit Scheduler(std::uint32_t gpuMsPerS = 0) : gpuMsPerS_(gpuMsPerS) {}

    void add(SessionKey session) { entries_[session]; }
    void remove(SessionKey session) { entries_.erase(session); }
    bool knows(SessionKey session) const { return entries_.contains(session); }

    std::vector<SessionKey> sessions() const;

    // Of every session, what it shows and what it has asked for; the same one may stand there twice.
    std::vector<const scene::Geometry*> geometryShown() const;

    void show(SessionKey session, Shown shown);
    void setStreaming(SessionKey session, bool streaming);

    // Frames that left or wait for the socket, and how many may.
    void setOccupied(SessionKey session, std::uint32_t frames, std::uint32_t window, std::uint64_t nowUs);

    // The ladder's level that the next moving frame gets.
    void setLevel(SessionKey session, int level) { entries_.at(session).level = level; }

    // Refused when too many wait already, or the session has used up its time.
    tl::expected<void, Busy> request(SessionKey session, std::uint32_t requestId, bool still, bool converge, std::uint64_t nowUs);

    // What the frame of `session` took.
    void spent(SessionKey session, std::uint64_t us);

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
        bool streaming = false, stillDue = false, losslessDue = false;
        int level = stream::Ladder::kBest;
        Convergence convergence = Convergence::None;
        std::uint32_t occupied = 0, window = 1;
        std::uint32_t drawing = 0, drawingResting = 0;  // not yet with the connection; those that rest go if something moves
        std::uint64_t notBeforeUs = 0, notRestingBeforeUs = 0;
        std::uint64_t quietSinceUs = 0;  // the last change, frame or acknowledgement: a slow frame is no idle time
        std::deque<Request> requests;
        std::uint64_t servedUs = 0;                 // GPU time, on clock_'s scale
        double leftUs = 0.0;                        // of gpuMsPerS_, at leftAtUs
        std::uint64_t leftAtUs = 0;
    };
    using Take = std::optional<FrameJob> (Scheduler::*)(SessionKey, Entry&, std::uint64_t nowUs, std::uint64_t& wakeUs);
    std::optional<FrameJob> takeTurn(Take take, bool starvedOnly, std::uint64_t nowUs, std::uint64_t& wakeUs);
    std::uint64_t startOf(const Entry& entry) const;
    bool affords(Entry& entry, std::uint64_t nowUs, std::uint64_t& wakeUs) const;
    std::optional<FrameJob> takeMoving(SessionKey session, Entry& entry, std::uint64_t nowUs, std::uint64_t& wakeUs);
    std::optional<FrameJob> takeStill(SessionKey session, Entry& entry, std::uint64_t nowUs, std::uint64_t& wakeUs);
    std::optional<FrameJob> takeConverging(SessionKey session, Entry& entry, std::uint64_t nowUs, std::uint64_t& wakeUs);
    static void startAnew(Entry& entry);
    static bool rests(const Entry& entry);
    FrameJob jobOf(SessionKey session, Entry& entry, bool still, bool converge, std::uint64_t nowUs);

    std::map<SessionKey, Entry> entries_;
    std::uint32_t gpuMsPerS_;
    std::uint64_t clock_ = 0;           // GPU time that the session served last had had
    std::uint64_t order_ = 0;
};

}  // namespace caustream
