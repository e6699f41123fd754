// How a viewer comes, comes back, follows another, and leaves.
#include <openssl/crypto.h>

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
#include "viewer.h"

namespace caustream {
namespace {

using protocol::CloseCode;
using protocol::DecodeError;
using protocol::ErrorCode;
using protocol::Json;


// Takes as long for a wrong token as for a right one.
bool sameToken(const std::string& a, const std::string& b) {
    return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

// Of a view's document these are its own, the rest is what it follows.
constexpr std::array<std::string_view, 2> kOwn = {"camera", "stream"};

Json followedDocument(const Json& leader, const Json& own, bool ownCamera) {
    Json document = leader;
    document.erase("stream");
    for (const std::string_view key : kOwn) {
        if (own.contains(key) && (key != "camera" || ownCamera)) {
            document[key] = own[key];
        }
    }
    return document;
}

constexpr const char* kLeaderGone = "the session that is followed has no connection; this is what it showed last";

}  // namespace

bool Viewer::admit(const protocol::Hello& hello) {
    const auto refuseWith = [&](DecodeError error, bool fatal) {
        error.id = hello.id;
        fatal ? fail(error) : refuse(error);
        return false;
    };
    if (ready_) {
        return refuseWith(problem(ErrorCode::BadRequest, "hello was said before", "op"), false);
    }
    if (!desk_.config.token.empty() && !sameToken(hello.token.value_or(""), desk_.config.token)) {
        return refuseWith(problem(ErrorCode::AuthRequired, "this server asks for its token", "token"), true);
    }
    if ((hello.role == protocol::Role::View) != hello.follow.has_value()) {
        return refuseWith(problem(ErrorCode::BadRequest, "role view goes with follow, and follow with it", hello.follow ? "role" : "follow"), false);
    }
    const bool takesOver = hello.resume && holderOf(hello.resume->session);
    if (desk_.sessions >= desk_.limits.sessions && !takesOver) {
        return refuseWith(problem(ErrorCode::Busy, "all " + std::to_string(desk_.limits.sessions) + " sessions are taken"), true);
    }
    return true;
}

session::Kept Viewer::keptSession() const {
    return {session_->document(), session_->rev(), session_->inputSeq, session_->inputClientUs};
}

// Its session goes on with another connection.
session::Kept Viewer::handOver() {
    session::Kept kept = keptSession();
    send(protocol::Goaway{protocol::Goaway::Reason::Takeover, 0, 0});
    fail(problem(ErrorCode::SessionTaken, "this session was taken up from another connection"));
    desk_.renderer->schedule([this](Scheduler& scheduler) { scheduler.remove(connection_.id()); });
    session_.reset();
    ready_ = false;
    --desk_.sessions;
    return kept;
}

// The connection that has the session now. A view id opens nothing.
Viewer* Viewer::holderOf(const std::string& session) const {
    Viewer* viewer = desk_.findSession(session);
    return viewer && viewer->session()->id() == session ? viewer : nullptr;
}

std::optional<session::Kept> Viewer::takeUp(const protocol::Resume& resume) {
    Viewer* holder = holderOf(resume.session);
    return holder ? holder->handOver() : desk_.kept.take(resume.session);
}

// The document that this session begins with: the client's, else the server's copy, else what it follows.
tl::expected<Json, DecodeError> Viewer::firstDocument(const protocol::Hello& hello, const std::optional<session::Kept>& kept) const {
    const bool theirs = hello.resume && hello.resume->state;
    Json own = theirs ? *hello.resume->state : kept ? kept->document : Json::object();
    if (!hello.follow) {
        return own;
    }
    if (const Viewer* leader = desk_.findSession(*hello.follow)) {
        return followedDocument(leader->session()->document(), own, true);
    }
    if (const session::Kept* leader = desk_.kept.find(*hello.follow)) {
        return followedDocument(leader->document, own, true);
    }
    if (theirs || kept) {
        return own;
    }
    return tl::unexpected(problem(ErrorCode::BadRequest, "there is no such session to follow", "follow"));
}

void Viewer::on(const protocol::Hello& hello) {
    if (!admit(hello)) {
        return;
    }
    // Nothing of a session may be lost over a hello that fails.
    std::string id = session::randomId();
    std::optional<session::Kept> kept;
    if (hello.resume) {
        kept = takeUp(*hello.resume);
        id = kept || session::isId(hello.resume->session) ? hello.resume->session : id;
    }
    resumed_ = kept.has_value();
    const std::uint32_t rev = std::max(kept ? kept->rev : 0u, hello.resume ? hello.resume->rev.value_or(0) : 0u);
    session_.emplace(id, desk_.limits, hello.strict, std::min(rev, 1u << 31));
    session_->inputSeq = std::max(kept ? kept->inputSeq : 0u, hello.resume ? hello.resume->inputSeq.value_or(0) : 0u);
    following_ = hello.follow.value_or("");
    if (const Viewer* leader = desk_.findSession(following_); leader && !leader->following_.empty()) {
        following_ = leader->following_;  // whom a view follows is followed by who follows the view
    }
    ++desk_.sessions;
    outbox_.setMaxInflight(hello.maxInflight);
    readsPng_ = std::ranges::find(hello.caps, "png") != hello.caps.end();
    const auto withdraw = [this, helloId = hello.id, id, kept](DecodeError error) {
        if (kept) {
            desk_.kept.keep(id, *kept, session::nowUs() + desk_.limits.resumeS * session::kUsPerS);
        }
        session_.reset();
        --desk_.sessions;
        error.id = helloId;
        refuse(error);
    };

    auto document = firstDocument(hello, kept);
    const auto applied = document ? session_->apply(*document) : tl::unexpected(document.error());
    if (!applied) {
        withdraw(applied.error());
        return;
    }
    // A scene that the client had uploaded may have to be uploaded again.
    std::vector<std::string> missing;
    const protocol::SceneRef& scene = applied->state.scene;
    if (scene.kind == protocol::SceneRef::Kind::Asset && !desk_.scenes.find(scene) && !isStored(scene.name)) {
        missing.push_back(scene.name);
        for (const char* ofThatScene : {"scene", "lights", "materials", "camera"}) {
            document->erase(ofThatScene);
        }
    }
    change({.patch = std::move(*document), .done = [this, withdraw, helloId = hello.id, missing](const auto& error) {
                if (error) {
                    withdraw(*error);
                } else {
                    welcome(helloId, missing);
                }
            }});
    log::info("hello").with("connection", connection_.id()).with("client", hello.clientName).with("version", hello.clientVersion)
        .with("role", following_.empty() ? "control" : "view").with("resumed", resumed_ ? "yes" : "no");
}

void Viewer::welcome(std::uint32_t id, std::vector<std::string> missingAssets) {
    protocol::Welcome message{.id = id, .session = session_->id(), .viewId = session_->viewId(), .server = desk_.serverId, .build = CAUSTREAM_VERSION};
    message.gpu = desk_.renderer->gpuName();
    message.resumed = resumed_;
    message.rev = session_->rev();
    message.state = session_->document();
    message.caps = {"jpeg", "png", "raw", "zstd", "shuffle", "f16", "f32", "resume", "follow", "ladder"};
    if (!desk_.config.recordDir.empty()) {
        message.caps.emplace_back("record");
    }
    for (const scene::BuiltinScene& builtin : scene::builtinScenes()) {
        message.scenes.emplace_back(builtin.name);
    }
    message.passes.assign(render::passNames().begin(), render::passNames().end());
    message.limits = desk_.limits;
    for (const optics::GlassPreset& glass : optics::kGlassPresets) {
        message.glasses.push_back({glass.name, session::onTheWire(glass.dispersion)});
    }
    message.missingAssets = std::move(missingAssets);
    message.heartbeatS = desk_.limits.pingS;
    send(message);
    if (!following_.empty() && !desk_.findSession(following_)) {
        tellFollow(kLeaderGone);
    }
}

bool Viewer::follows(const Viewer& other) const {
    const session::Session* leader = other.session();
    return ready_ && !following_.empty() && leader && &other != this && leader->isNamed(following_);
}

void Viewer::tellFollowers() {
    desk_.eachViewer([this](Viewer& viewer) {
        if (viewer.follows(*this)) {
            viewer.follow(*session_);
        }
    });
}

// Shows what `leader` has come to, with this viewer's own camera and stream; of another scene with the leader's camera.
void Viewer::follow(const session::Session& leader) {
    if (connection_.closing() || loading_) {
        return;  // conclude() comes back here once it is loaded
    }
    heardUs_ = session::nowUs();
    const bool sameScene = leader.base() == session_->base();
    const Json document = followedDocument(leader.document(), session_->document(), sameScene);
    auto proposal = session_->adopt(document, leader);
    const auto error = proposal ? show(std::move(*proposal)) : std::optional(proposal.error());
    tellFollow(error ? "what is followed cannot be shown here: " + error->message : "");
    if (!error && sameScene) {
        toldLate_ = true;
    } else if (!error) {
        sendState();
    }
}

void Viewer::tellFollow(std::string problem) {
    if (problem != followProblem_) {
        send(protocol::Status{problem.empty() ? protocol::Status::Level::Info : protocol::Status::Level::Warning, "follow", problem});
        followProblem_ = std::move(problem);
    }
}

// A view changes its own camera and stream, and nothing of what it follows.
bool Viewer::mayPatch(const Json& patch, std::optional<std::uint32_t> id) {
    if (following_.empty()) {
        return true;
    }
    for (const auto& [key, value] : patch.items()) {
        if (std::ranges::find(kOwn, key) == kOwn.end()) {
            refuse(problem(ErrorCode::Forbidden, "a view changes its camera and its stream only", key, id));
            return false;
        }
    }
    return true;
}

void Viewer::end() {
    if (!ready_) {
        return;
    }
    desk_.kept.keep(session_->id(), keptSession(), session::nowUs() + desk_.limits.resumeS * session::kUsPerS);
    desk_.eachViewer([this](Viewer& viewer) {
        if (viewer.follows(*this)) {
            viewer.tellFollow(kLeaderGone);
        }
    });
}

}  // namespace caustream
