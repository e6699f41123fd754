// How a viewer's state document changes, and how its scenes and uploaded files come.
#include <exception>
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

DecodeError problem(ErrorCode code, std::string message, std::string field, std::optional<std::uint32_t> id = {}) {
    return {.code = code, .message = std::move(message), .field = std::move(field), .id = id};
}

// Runs on the load thread: whatever goes wrong there is that file's problem.
template <typename Read>
std::shared_ptr<tl::expected<scene::Scene, scene::LoadError>> readScene(const Read& read) {
    using Loaded = tl::expected<scene::Scene, scene::LoadError>;
    try {
        return std::make_shared<Loaded>(read());
    } catch (const std::exception& failure) {
        return std::make_shared<Loaded>(tl::unexpected(scene::LoadError{failure.what()}));
    }
}

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
    // Whatever was captured comes back to this thread; the viewer may have gone by then.
    auto waiting = std::make_shared<std::pair<protocol::Applied, Change>>(std::move(applied), std::move(change));
    desk_.loader->submit([desk = &desk_, key = connection_.id(), ref, waiting] {
        auto result = readScene([&] { return scene::loadBuiltin(ref.name); });
        desk->post([desk, key, ref, waiting, result] {
            if (Viewer* viewer = desk->find(key)) {
                viewer->loaded(ref, std::move(*result), std::move(waiting->first), std::move(waiting->second));
            }
        });
    });
}

void Viewer::loaded(const SceneRef& ref, Loaded result, protocol::Applied applied, Change change) {
    loading_ = false;
    if (!session_) {
        return;  // taken up from another connection meanwhile
    }
    if (!result) {
        change.done(problem(ErrorCode::AssetInvalid, result.error().message, "scene"));
    } else {
        // Someone else may have asked for the same scene in the meantime: one geometry serves both.
        std::shared_ptr<const scene::Scene> scene = desk_.scenes.find(ref);
        if (!scene) {
            scene = std::make_shared<const scene::Scene>(std::move(*result));
            desk_.scenes.put(ref, scene);
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
    return show(std::move(*proposal), change.input);
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

void Viewer::on(const protocol::AssetBegin& begin) {
    if (!following_.empty()) {
        refuse(problem(ErrorCode::Forbidden, "a view changes its camera and its stream only", "op", begin.id));
        return;
    }
    if (upload_) {
        refuse(problem(ErrorCode::Busy, "asset " + std::to_string(upload_->asset()) + " is still on its way; end or abort it", "op",
                       begin.id));
        return;
    }
    protocol::Ok reply{.id = begin.id};
    const std::uint32_t asset = nextAsset_++;
    if (desk_.scenes.find({SceneRef::Kind::Asset, begin.sha256})) {
        knownAsset_ = {asset, begin.sha256};
        reply.offer = protocol::AssetOffer{asset, begin.size, 0};
    } else {
        upload_.emplace(asset, begin, desk_.limits);
        reply.offer = upload_->offer();
    }
    send(reply);
}

void Viewer::chunk(std::string_view message) {
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(message.data()), message.size());
    const auto header = protocol::decodeChunkHeader(bytes, desk_.limits);
    if (!header) {
        refuse(header.error());
        return;
    }
    if (!upload_ || header->asset != upload_->asset()) {
        refuse(problem(ErrorCode::BadRequest, "no such upload was begun", "asset"));
        return;
    }
    const auto credit = upload_->add(*header, bytes.subspan(header->headerLen, header->payloadLen));
    if (!credit) {
        refuse(credit.error());
    } else if (*credit) {
        send(**credit);
    }
}

void Viewer::on(const protocol::AssetEnd& end) {
    if (knownAsset_ && knownAsset_->first == end.asset) {
        const std::string sha256 = std::exchange(knownAsset_, std::nullopt)->second;
        if (const auto scene = desk_.scenes.find({SceneRef::Kind::Asset, sha256})) {
            reportAsset(end.id, sha256, *scene);
        } else {
            refuse(problem(ErrorCode::AssetMissing, "the file was dropped meanwhile; send it again", "asset", end.id));
        }
        return;
    }
    if (!upload_ || upload_->asset() != end.asset) {
        refuse(problem(ErrorCode::BadRequest, "no such upload was begun", "asset", end.id));
        return;
    }
    const std::string sha256 = upload_->sha256();
    auto file = upload_->finish();
    upload_.reset();
    if (!file) {
        DecodeError error = file.error();
        error.id = end.id;
        refuse(error);
        return;
    }
    auto bytes = std::make_shared<const std::vector<std::byte>>(std::move(*file));
    desk_.loader->submit([desk = &desk_, key = connection_.id(), id = end.id, sha256, bytes] {
        auto result = readScene([&] { return scene::loadGlb(*bytes, "file " + sha256.substr(0, 8)); });
        desk->post([desk, key, id, sha256, result] {
            if (Viewer* viewer = desk->find(key)) {
                viewer->assetLoaded(id, sha256, std::move(*result));
            }
        });
    });
}

void Viewer::assetLoaded(std::uint32_t id, const std::string& sha256, Loaded result) {
    if (!result) {
        refuse(problem(ErrorCode::AssetInvalid, result.error().message, "asset", id));
        return;
    }
    auto scene = std::make_shared<const scene::Scene>(std::move(*result));
    desk_.scenes.put({SceneRef::Kind::Asset, sha256}, scene);
    reportAsset(id, sha256, *scene);
}

void Viewer::reportAsset(std::uint32_t id, const std::string& sha256, const scene::Scene& scene) {
    const scene::Geometry& geometry = *scene.geometry;
    protocol::Ok reply{.id = id};
    reply.report = protocol::AssetReport{.sha256 = sha256,
                                         .meshes = static_cast<std::uint32_t>(geometry.objects.size()),
                                         .vertices = static_cast<std::uint32_t>(geometry.vertices.size()),
                                         .triangles = static_cast<std::uint32_t>(geometry.indices.size() / 3),
                                         .warnings = scene.warnings};
    send(reply);
}

void Viewer::on(const protocol::AssetAbort& abort) {
    if (upload_ && upload_->asset() == abort.asset) {
        upload_.reset();
    } else if (knownAsset_ && knownAsset_->first == abort.asset) {
        knownAsset_.reset();
    } else {
        refuse(problem(ErrorCode::BadRequest, "no such upload was begun", "asset"));
    }
}

}  // namespace caustream
