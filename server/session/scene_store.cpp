#include "session/scene_store.h"

#include <algorithm>
#include <utility>

namespace caustream::session {
namespace {

std::string keyOf(const protocol::SceneRef& ref) {
    return (ref.kind == protocol::SceneRef::Kind::Builtin ? "builtin:" : "asset:") + ref.name;
}

std::size_t bytesOf(const scene::Geometry& geometry) {
    std::size_t bytes = geometry.vertices.size() * sizeof(scene::Vertex) + geometry.indices.size() * sizeof(std::uint32_t);
    for (const scene::Texture& texture : geometry.textures) {
        bytes += texture.rgba.size();
    }
    return bytes;
}

}  // namespace

std::shared_ptr<const scene::Scene> SceneStore::find(const protocol::SceneRef& ref) {
    const auto known = known_.find(keyOf(ref));
    if (known == known_.end()) {
        return nullptr;
    }
    std::shared_ptr<const scene::Scene> scene = known->second.lock();
    if (!scene) {
        known_.erase(known);
        return nullptr;
    }
    const auto kept = std::ranges::find(kept_, known->first, &Kept::key);
    if (kept != kept_.end()) {
        kept_.splice(kept_.begin(), kept_, kept);
    }
    return scene;
}

void SceneStore::put(const protocol::SceneRef& ref, std::shared_ptr<const scene::Scene> scene) {
    const std::string key = keyOf(ref);
    kept_.remove_if([&](const Kept& kept) { return kept.key == key; });
    kept_.push_front({key, scene, bytesOf(*scene->geometry)});
    known_[key] = std::move(scene);
    std::size_t total = 0;
    std::size_t keep = 0;
    for (const Kept& kept : kept_) {
        total += kept.bytes;
        if (keep > 0 && total > kKeptBytes) {
            break;
        }
        ++keep;
    }
    kept_.resize(keep);
}

}  // namespace caustream::session
