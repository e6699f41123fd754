// How a viewer's state document changes, and how its scenes come.
#include <utility>

#include "log.h"
#include "scene/builtin_scenes.h"
#include "session/clock.h"
#include "session/scene_overrides.h"
#include "session/scene_summary.h"
#include "viewer.h"

namespace caustream {
namespace {

using protocol::DecodeError;
using protocol::ErrorCode;
using protocol::SceneRef;

bool isBuiltin(const std::string& name) {
    for (const scene::BuiltinScene& builtin : scene::builtinScenes()) {
        if (builtin.name == name) {
            return true;
        }
    }
    return false;
}

std::string builtinNames() {
    std::string names;
    for (const scene::BuiltinScene& builtin : scene::builtinScenes()) {
        names += (names.empty() ? "" : ", ") + std::string(builtin.name);
    }
    return names;
}

}  // namespace

void Viewer::change(Change change) {
    auto applied = session_->apply(change.patch);
    if (!applied) {
        change.done(applied.error());
        return;
    }
    const SceneRef ref = applied->state.scene;
    std::shared_ptr<const scene::Scene> base =
        session_->base() && ref == session_->state().scene ? session_->base() : desk_.scenes.find(ref);
    if (base) {
        conclude(std::move(*applied), std::move(base), change);
    } else if (ref.kind == SceneRef::Kind::Asset && isStored(ref.name)) {
        load(ref, std::move(*applied), std::move(change));
    } else if (ref.kind == SceneRef::Kind::Asset) {
        change.done(problem(ErrorCode::AssetMissing, "this file has not been uploaded", "scene"));
    } else if (!isBuiltin(ref.name)) {
        change.done(problem(ErrorCode::Unsupported, "there is no scene '" + ref.name + "'; there are: " + builtinNames(), "scene"));
    } else {
        load(ref, std::move(*applied), std::move(change));
    }
}

void Viewer::load(const SceneRef& ref, protocol::Applied applied, Change change) {
    loading_ = true;
    const Source source = ref.kind == SceneRef::Kind::Builtin
                              ? Source([name = ref.name](const scene::LoadObserver& observer) { return scene::loadBuiltin(name, observer); })
                              : storedAsset(*desk_.assets, ref.name);
    // Whatever was captured comes back to this thread; the viewer may have gone by then.
    auto waiting = std::make_shared<std::pair<protocol::Applied, Change>>(std::move(applied), std::move(change));
    read(source, [ref, waiting](Viewer& viewer, Loaded result) {
        viewer.loaded(ref, std::move(result), std::move(waiting->first), std::move(waiting->second));
    });
}

void Viewer::loaded(const SceneRef& ref, Loaded result, protocol::Applied applied, Change change) {
    loading_ = false;
    if (!session_) {
        return;  // taken up from another connection meanwhile
    }
    if (!result) {
        const bool lost = ref.kind == SceneRef::Kind::Asset && !isStored(ref.name);
        change.done(problem(lost ? ErrorCode::AssetMissing : ErrorCode::AssetInvalid, result.error().message, "scene"));
    } else {
        // Someone else may have asked for the same scene in the meantime: one geometry serves both.
        std::shared_ptr<const scene::Scene> scene = desk_.scenes.find(ref);
        if (!scene) {
            scene = desk_.scenes.put(ref, std::move(*result));
        }
        conclude(std::move(applied), std::move(scene), change);
    }
    while (!loading_ && !deferred_.empty() && !connection_.closing()) {
        const auto [message, binary] = std::move(deferred_.front());
        deferred_.pop_front();
        deferredBytes_ -= message.size();
        handle(message, binary);
    }
}

void Viewer::conclude(protocol::Applied applied, std::shared_ptr<const scene::Scene> base, const Change& change) {
    const bool first = !ready_;
    const auto error = finish(std::move(applied), std::move(base), change);
    change.done(error);
    if (!error && (change.patch.contains("scene") || first)) {
        sendState();
    }
    if (!error) {
        tellFollowers();
    }
    // What is followed may have changed while this was being loaded.
    if (Viewer* leader = !error && first && !following_.empty() ? desk_.findSession(following_) : nullptr) {
        follow(*leader->session());
    }
}

std::optional<DecodeError> Viewer::finish(protocol::Applied applied, std::shared_ptr<const scene::Scene> base,
                                          const Change& change) {
    auto proposal = session_->propose(std::move(applied), std::move(base));
    if (!proposal) {
        return proposal.error();
    }
    auto error = show(std::move(*proposal), change.input);
    if (!error) {
        noteChange(change.patch, change.input);
    }
    return error;
}

// What is wrong with it, or nothing: then it is the session's state, and what the renderer draws next.
std::optional<DecodeError> Viewer::show(session::Proposal proposal, const std::optional<protocol::Input>& input) {
    auto view = resolveRequest(proposal.applied.state, proposal.resolved, readsPng_);
    if (!view) {
        return view.error();
    }
    if (const std::size_t bytes = estimatedBytes(*view); bytes > desk_.limits.viewerBytes) {
        return problem(ErrorCode::Busy, "this takes about " + std::to_string(bytes >> 20) + " MiB of the " + std::to_string(desk_.limits.viewerBytes >> 20) +
                                            " that one viewer may have; ask for a smaller picture, map or scene", "patch");
    }
    const bool otherScene = session_->commit(std::move(proposal));
    if (input) {
        session_->inputSeq = input->seq;
        session_->inputClientUs = input->tUs;
    }
    outbox_.setFrameRate(view->stream.maxFps);
    Shown shown{.view = std::make_shared<const View>(std::move(*view)),
                .rev = session_->rev(),
                .inputSeq = session_->inputSeq,
                .clientUs = session_->inputClientUs,
                .changedUs = session::nowUs()};
    outbox_.discardResting();
    desk_.renderer->schedule([&](Scheduler& scheduler) {
        if (!std::exchange(ready_, true)) {
            scheduler.add(connection_.id());
        }
        tell(scheduler);
        scheduler.show(connection_.id(), std::move(shown));
    });
    if (otherScene) {
        desk_.renderer->collect();
    }
    return std::nullopt;
}

void Viewer::sendState() {
    const scene::Scene& scene = *session_->resolved();
    const auto camera = session::cameraOf(scene, session_->state());  // checked when the document was taken
    send(protocol::StateMessage{session_->rev(), session::resolvedDocument(session_->state(), scene, camera.value()),
                                session::summarize(scene)});
}

}  // namespace caustream
