// The scenes there are, by name or hash, so that viewers of one scene share its geometry. What is shown stays; what no one
// shows any more stays within a budget, the newest first. Network thread only.
#pragma once
#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <string>

#include "protocol/state.h"
#include "scene/scene.h"

namespace caustream::session {

class SceneStore {
   public:
    explicit SceneStore(std::size_t budgetBytes) : budgetBytes_(budgetBytes) {}

    // Nothing: not loaded (a built-in one can be, an asset has to be uploaded).
    std::shared_ptr<const scene::Scene> find(const protocol::SceneRef& ref);

    // The scene as all who find it will have it.
    std::shared_ptr<const scene::Scene> put(const protocol::SceneRef& ref, scene::Scene scene);

    // Lets go of what is beyond the budget, but for the newest. To be called now and then: who stops to show a scene does
    // not say so.
    void trim();

    std::size_t idleBytes() const;  // of scenes that no one shows

   private:
    using Order = std::list<std::string>;
    struct Entry {
        std::shared_ptr<const scene::Scene> scene;
        std::size_t bytes = 0;
        Order::iterator place;
        // Viewers hold the geometry, by this scene or by one with their overrides; so does the renderer until it collects.
        bool idle() const { return scene.use_count() == 1 && scene->geometry.use_count() == 1; }
    };

    std::size_t budgetBytes_;
    std::map<std::string, Entry> entries_;
    Order order_;  // newest first
};

}  // namespace caustream::session
