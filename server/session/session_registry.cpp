#include "session/session_registry.h"

#include <algorithm>
#include <utility>

#include "session/random_id.h"

namespace caustream::session {

void SessionRegistry::keep(const std::string& id, Kept kept, std::uint64_t untilUs) {
    if (kept_.size() >= kMost && !kept_.contains(id)) {
        kept_.erase(std::ranges::min_element(kept_, {}, [](const auto& entry) { return entry.second.untilUs; }));
    }
    kept_.insert_or_assign(id, Entry{std::move(kept), viewIdOf(id), untilUs});
}

std::optional<Kept> SessionRegistry::take(const std::string& id) {
    const auto entry = kept_.find(id);
    if (entry == kept_.end()) {
        return std::nullopt;
    }
    Kept kept = std::move(entry->second.kept);
    kept_.erase(entry);
    return kept;
}

const Kept* SessionRegistry::find(std::string_view idOrViewId) const {
    if (const auto entry = kept_.find(idOrViewId); entry != kept_.end()) {
        return &entry->second.kept;
    }
    const auto entry = std::ranges::find(kept_, idOrViewId, [](const auto& one) -> const std::string& { return one.second.viewId; });
    return entry == kept_.end() ? nullptr : &entry->second.kept;
}

void SessionRegistry::sweep(std::uint64_t nowUs) {
    std::erase_if(kept_, [&](const auto& entry) { return entry.second.untilUs <= nowUs; });
}

}  // namespace caustream::session
