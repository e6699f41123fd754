// How a viewer's uploaded files come, and how files are read.
#include <exception>
#include <utility>

#include "log.h"
#include "session/clock.h"
#include "session/load_progress.h"
#include "viewer.h"

namespace caustream {
namespace {

using protocol::DecodeError;
using protocol::ErrorCode;
using protocol::SceneRef;

// Of one viewer, each in memory whole.
constexpr std::size_t kMostReading = 2;

std::string nameOf(const std::string& sha256) { return "file " + sha256.substr(0, 8); }

const scene::LoadError kEnded{.message = "its reading was ended", .cancelled = true};

}  // namespace

// What read() calls with a file of the shared folder.
Viewer::Source Viewer::storedAsset(const session::AssetDirectory& folder, const std::string& sha256) {
    return [&folder, sha256](const scene::LoadObserver& observer) -> Loaded {
        const auto bytes = folder.read(sha256);
        if (!bytes) {
            return tl::unexpected(scene::LoadError{"the file is no more in the servers' folder; upload it again"});
        }
        return scene::loadGlb(*bytes, nameOf(sha256), {}, observer);
    };
}

bool Viewer::isStored(const std::string& sha256) const { return desk_.assets && desk_.assets->contains(sha256); }

// `done` is called on this thread unless this viewer has gone by then. Setting what is returned to true ends the reading.
std::shared_ptr<std::atomic<bool>> Viewer::read(Source source, std::function<void(Viewer&, Loaded)> done) {
    ++loads_;
    auto waiting = std::make_shared<std::function<void(Viewer&, Loaded)>>(std::move(done));
    return desk_.loader->submit(connection_.id(), [desk = &desk_, key = connection_.id(), source = std::move(source), waiting](
                                                      const std::atomic<bool>& ended) {
        session::LoadProgress progress(session::nowUs());
        const scene::LoadObserver observer = [&](double share) {
            if (!ended && progress.due(session::nowUs())) {
                desk->post([desk, key, percent = static_cast<int>(100 * share)] {
                    if (Viewer* viewer = desk->find(key)) {
                        viewer->tellProgress(percent);
                    }
                });
            }
            return !ended;
        };
        auto result = std::make_shared<Loaded>(tl::unexpected(kEnded));
        try {
            if (!ended) {
                *result = source(observer);
            }
        } catch (const std::exception& failure) {  // whatever goes wrong here is that file's problem
            *result = tl::unexpected(scene::LoadError{failure.what()});
        }
        desk->post([desk, key, waiting, result] {
            if (Viewer* viewer = desk->find(key)) {
                viewer->hasRead();
                (*waiting)(*viewer, std::move(*result));
            }
        });
    });
}

void Viewer::tellProgress(int percent) {
    tellsProgress_ = true;
    send(protocol::Status{.key = "load", .message = "reading the file: " + std::to_string(percent) + "%"});
}

void Viewer::hasRead() {
    --loads_;
    if (loads_ == 0 && std::exchange(tellsProgress_, false)) {
        send(protocol::Status{.key = "load", .message = {}});
    }
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
    if (reading_.size() >= kMostReading) {
        refuse(problem(ErrorCode::Busy, "the files before it are still being read", "op", begin.id));
        return;
    }
    protocol::Ok reply{.id = begin.id};
    const std::uint32_t asset = nextAsset_++;
    if (desk_.scenes.find({SceneRef::Kind::Asset, begin.sha256}) || isStored(begin.sha256)) {
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
        } else if (isStored(sha256)) {
            readAsset(end.id, end.asset, sha256, storedAsset(*desk_.assets, sha256));
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
    readAsset(end.id, end.asset, sha256, [folder = desk_.assets, bytes, sha256](const scene::LoadObserver& observer) {
        auto scene = scene::loadGlb(*bytes, nameOf(sha256), {}, observer);
        // Before the reply: who has that may go to another server.
        if (const auto stored = scene && folder ? folder->write(sha256, *bytes) : tl::expected<void, std::string>(); !stored) {
            log::warning("asset").with("message", stored.error());
        }
        return scene;
    });
}

void Viewer::readAsset(std::uint32_t id, std::uint32_t asset, const std::string& sha256, Source source) {
    reading_[asset] = read(std::move(source), [id, asset, sha256](Viewer& viewer, Loaded result) {
        viewer.reading_.erase(asset);
        viewer.assetLoaded(id, sha256, std::move(result));
    });
}

void Viewer::assetLoaded(std::uint32_t id, const std::string& sha256, Loaded result) {
    const SceneRef ref{SceneRef::Kind::Asset, sha256};
    if (!result) {
        const ErrorCode code = result.error().cancelled ? ErrorCode::AssetMissing : ErrorCode::AssetInvalid;
        refuse(problem(code, result.error().message, "asset", id));
        return;
    }
    // Someone else may have sent the same file in the meantime: one geometry serves both.
    std::shared_ptr<const scene::Scene> scene = desk_.scenes.find(ref);
    if (!scene) {
        scene = desk_.scenes.put(ref, std::move(*result));
    }
    ++desk_.counters.uploads;
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
    } else if (const auto reading = reading_.find(abort.asset); reading != reading_.end()) {
        *reading->second = true;  // the reply to asset.end is then an error
    } else {
        refuse(problem(ErrorCode::BadRequest, "no such upload was begun", "asset"));
    }
}

}  // namespace caustream
