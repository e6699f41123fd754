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
    // Viewers and the renderer hold the geometry by a pointer of their own, whose count is theirs alone: the renderer sees
    // that no one shows it any more though it is kept here, and frees its copy on the GPU.
    struct Kept {
        scene::Scene scene;
        std::size_t bytes = 0;
        std::weak_ptr<const scene::Scene> shared;
        std::weak_ptr<const scene::Geometry> shown;
        bool idle() const { return shown.expired(); }
    };
    using Order = std::list<std::string>;
    struct Entry {
        Kept kept;
        Order::iterator place;
    };
    std::shared_ptr<const scene::Scene> share(Kept& kept);

    std::size_t budgetBytes_;
    std::map<std::string, Entry> entries_;
    Order order_;  // newest first
};

}  // namespace caustream::session
