// The scenes there are, by name or hash, so that viewers of one scene share its geometry. Network thread only.
#pragma once
#include <list>
#include <map>
#include <memory>
#include <string>

#include "protocol/state.h"
#include "scene/scene.h"

namespace caustream::session {

class SceneStore {
   public:
    // Nothing: not loaded (a built-in one can be, an asset has to be uploaded).
    std::shared_ptr<const scene::Scene> find(const protocol::SceneRef& ref);

    void put(const protocol::SceneRef& ref, std::shared_ptr<const scene::Scene> scene);

   private:
    // Uploaded scenes stay while one is shown, and the newest of them a while longer.
    static constexpr std::size_t kKeptBytes = 128u << 20;

    struct Kept {
        std::string key;
        std::shared_ptr<const scene::Scene> scene;
        std::size_t bytes = 0;
    };
    std::map<std::string, std::weak_ptr<const scene::Scene>> known_;
    std::list<Kept> kept_;  // newest first
};

}  // namespace caustream::session
