#include "session/scene_store.h"

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
    const auto found = entries_.find(keyOf(ref));
    if (found == entries_.end()) {
        return nullptr;
    }
    order_.splice(order_.begin(), order_, found->second.place);
    return found->second.scene;
}

std::shared_ptr<const scene::Scene> SceneStore::put(const protocol::SceneRef& ref, scene::Scene scene) {
    const std::string key = keyOf(ref);
    if (const auto old = entries_.find(key); old != entries_.end()) {
        order_.erase(old->second.place);
        entries_.erase(old);
    }
    order_.push_front(key);
    const std::size_t bytes = bytesOf(*scene.geometry);
    auto shared = std::make_shared<const scene::Scene>(std::move(scene));
    entries_[key] = {.scene = shared, .bytes = bytes, .place = order_.begin()};
    trim();
    return shared;
}

void SceneStore::trim() {
    std::size_t idle = 0;
    for (auto place = order_.begin(); place != order_.end();) {
        const bool newest = place == order_.begin();  // it was uploaded to be shown next
        const auto entry = entries_.find(*place++);
        if (entry->second.idle() && (idle += entry->second.bytes) > budgetBytes_ && !newest) {
            idle -= entry->second.bytes;
            order_.erase(entry->second.place);
            entries_.erase(entry);
        }
    }
}

std::size_t SceneStore::idleBytes() const {
    std::size_t bytes = 0;
    for (const auto& [key, entry] : entries_) {
        bytes += entry.idle() ? entry.bytes : 0;
    }
    return bytes;
}

}  // namespace caustream::session
