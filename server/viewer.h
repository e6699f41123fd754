// One connected client: what it says, and what happens then. Network thread only.
#pragma once
#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "config.h"
#include "counters.h"
#include "net/websocket_server.h"
#include "protocol/messages.h"
#include "render_thread.h"
#include "scene/gltf_loader.h"
#include "session/asset_directory.h"
#include "session/asset_upload.h"
#include "session/load_pool.h"
#include "session/outbox.h"
#include "session/recorder.h"
#include "session/scene_store.h"
#include "session/session.h"
#include "session/session_registry.h"
#include "session/token_bucket.h"

namespace caustream {

class Viewer;

// What is wrong with a message, for refuse() and fail().
inline protocol::DecodeError problem(protocol::ErrorCode code, std::string message, std::string field = {},
                                     std::optional<std::uint32_t> id = {}) {
    return {.code = code, .message = std::move(message), .field = std::move(field), .id = id};
}

// What all viewers share; the service owns it and all it points to.
struct Desk {
    const Config& config;
    protocol::Limits limits;
    std::string serverId;
    session::SceneStore scenes{limits.assetCacheBytes};
    const session::AssetDirectory* assets = nullptr;        // nothing: uploads end with this server
    RenderThread* renderer = nullptr;
    session::LoadPool* loader = nullptr;
    std::function<void(std::function<void()>)> post;        // onto the network thread
    std::function<Viewer*(SessionKey)> find;                // nothing once it has gone
    std::function<Viewer*(std::string_view)> findSession;   // by its id or view id
    std::function<void(const std::function<void(Viewer&)>&)> eachViewer;
    session::SessionRegistry kept;                          // sessions without a connection
    std::uint32_t sessions = 0;                             // that have said hello
    bool draining = false;
    Counters counters;
};

class Viewer {
   public:
    Viewer(Desk& desk, net::Connection& connection);
    ~Viewer();

    void received(std::string_view message, bool binary);
    std::optional<session::Outgoing> next();
    void deliver(Delivery&& delivery);
    void tick(std::uint64_t nowUs);
    void end();  // the connection is gone: its session waits for who comes back

    // Says goodbye; the connection closes once nothing is on its way to the viewer any more.
    void drain(protocol::Goaway::Reason reason);
    void leave();  // closes now, whatever is on its way
    void say(const protocol::Status& status) { send(status); }
    void fail(const protocol::DecodeError& error);  // and close

    bool ready() const { return ready_; }
    bool streaming() const { return streaming_; }

    const session::Session* session() const { return ready_ ? &*session_ : nullptr; }
    const session::Outbox& outbox() const { return outbox_; }

   private:
    using Loaded = tl::expected<scene::Scene, scene::LoadError>;
    using Source = std::function<Loaded(const scene::LoadObserver&)>;  // runs on a load thread
    using Outcome = std::function<void(const std::optional<protocol::DecodeError>&)>;

    // A change of the state document on its way, which may have to wait for its scene.
    struct Change {
        protocol::Json patch;
        std::optional<protocol::Input> input;
        Outcome done;  // called once, before the `state` message that may follow
    };

    void handle(std::string_view message, bool binary);
    void on(const protocol::Hello& hello);
    void on(const protocol::Update& update);
    void on(const protocol::Input& input);
    void on(const protocol::StreamStart& start);
    void on(const protocol::StreamPause& pause);
    void on(const protocol::StreamResume& resume);
    void on(const protocol::FrameRequest& request);
    void on(const protocol::Ack& ack);
    void on(const protocol::AssetBegin& begin);
    void on(const protocol::AssetEnd& end);
    void on(const protocol::AssetAbort& abort);
    void on(const protocol::Record& record);
    void on(const protocol::Ping& ping);
    void chunk(std::string_view message);

    // viewer_record.cpp: for the session's log, where it is kept
    void noteChange(const protocol::Json& patch, const std::optional<protocol::Input>& input);
    void noteRequest(const protocol::FrameRequest& request);
    void noteAnswer(std::uint32_t requestId, const session::OutgoingFrame& frame);
    void note(protocol::Json line);

    bool admit(const protocol::Hello& hello);
    std::optional<session::Kept> takeUp(const protocol::Resume& resume);
    session::Kept handOver();
    session::Kept keptSession() const;
    tl::expected<protocol::Json, protocol::DecodeError> firstDocument(const protocol::Hello& hello, const std::optional<session::Kept>& kept) const;
    bool follows(const Viewer& other) const;
    void follow(const session::Session& leader);
    void tellFollow(std::string problem);
    Viewer* holderOf(const std::string& session) const;
    void tellFollowers();
    bool mayPatch(const protocol::Json& patch, std::optional<std::uint32_t> id);
    void welcome(std::uint32_t id, std::vector<std::string> missingAssets);
    void change(Change change);
    void load(const protocol::SceneRef& ref, protocol::Applied applied, Change change);
    bool isStored(const std::string& sha256) const;
    static Source storedAsset(const session::AssetDirectory& folder, const std::string& sha256);
    std::shared_ptr<std::atomic<bool>> read(Source source, std::function<void(Viewer&, Loaded)> done);
    void readAsset(std::uint32_t id, std::uint32_t asset, const std::string& sha256, Source source);
    void tellProgress(int percent);
    void hasRead();
    void loaded(const protocol::SceneRef& ref, Loaded result, protocol::Applied applied, Change change);
    std::optional<protocol::DecodeError> finish(protocol::Applied applied, std::shared_ptr<const scene::Scene> base,
                                                const Change& change);
    std::optional<protocol::DecodeError> show(session::Proposal proposal, const std::optional<protocol::Input>& input = {});
    void conclude(protocol::Applied applied, std::shared_ptr<const scene::Scene> base, const Change& change);
    void assetLoaded(std::uint32_t id, const std::string& sha256, Loaded result);
    void reportAsset(std::uint32_t id, const std::string& sha256, const scene::Scene& scene);

    template <typename Message>
    void send(const Message& message) {
        outbox_.text(protocol::encode(message));
        connection_.requestWrite();
    }
    void ok(std::uint32_t id);
    void refuse(const protocol::DecodeError& error, std::optional<std::uint32_t> retryMs = {});
    void sendState();
    void endIfIdle();
    void setStreaming(std::uint32_t id, bool streaming);
    void updateOccupied();
    void tell(Scheduler& scheduler) const;
    void sendStats(std::uint64_t nowUs);
    void rest(std::uint64_t nowUs);

    Desk& desk_;
    net::Connection& connection_;
    session::Outbox outbox_;
    std::optional<session::Session> session_;
    bool resumed_ = false;
    std::string following_;   // role view: what hello.follow named; empty: a session of its own
    std::string followProblem_;  // as last told
    bool toldLate_ = false;   // what it follows has changed, and no `state` has said so
    bool ready_ = false;    // welcomed, and known to the scheduler
    bool draining_ = false;
    bool loading_ = false;  // messages wait in deferred_, so that they apply in order
    std::deque<std::pair<std::string, bool>> deferred_;
    std::size_t deferredBytes_ = 0;
    session::TokenBucket texts_, chunks_;
    std::uint64_t openedUs_, heardUs_;
    bool idle_ = false;     // said nothing for long: its stream rests

    std::optional<session::AssetUpload> upload_;
    std::optional<std::pair<std::uint32_t, std::string>> knownAsset_;  // begun, but already here: number, hash
    std::uint32_t nextAsset_ = 1;
    std::map<std::uint32_t, std::shared_ptr<std::atomic<bool>>> reading_;  // assets, and what ends the reading
    int loads_ = 0;              // files being read, or waiting for it
    bool tellsProgress_ = false;

    std::optional<session::Recorder> recorder_;
    std::uint32_t requestsPending_ = 0;
    bool streaming_ = false, wantsStats_ = false, readsPng_ = false;
    std::uint64_t statsSentUs_ = 0;
};

}  // namespace caustream
