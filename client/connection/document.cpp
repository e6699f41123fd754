#include "client/connection/document.h"

#include <algorithm>
#include <utility>

namespace caustream::connection {
namespace {

// Whether one patch can do what `patch` and then `next` do: what the first takes out whole, the second must not fill again.
bool canExtend(const Json& patch, const Json& next) {
    for (const auto& [key, value] : next.items()) {
        const auto before = patch.find(key);
        if (before == patch.end() || !value.is_object()) continue;
        if (!before->is_object() || !canExtend(*before, value)) return false;
    }
    return true;
}

void append(std::vector<Json>& patches, const Json& patch) {
    if (patch.empty()) return;
    if (!patches.empty() && canExtend(patches.back(), patch))
        protocol::extendPatch(patches.back(), patch);
    else
        patches.push_back(patch);
}

}  // namespace

Json lacking(const Json& has, const Json& wanted) {
    Json patch = Json::object();
    for (const auto& [key, value] : wanted.items()) {
        const auto there = has.find(key);
        if (there == has.end()) {
            patch[key] = value;
        } else if (there->is_object() && value.is_object()) {
            Json inner = lacking(*there, value);
            if (!inner.empty()) patch[key] = std::move(inner);
        } else if (*there != value) {
            patch[key] = value;
        }
    }
    return patch;
}

Json Document::wanted() const {
    Json document = taken_;
    for (const Told& told : told_) document.merge_patch(told.patch);
    for (const Json& patch : waiting_) document.merge_patch(patch);
    return document;
}

void Document::keep(const Json& patch) {
    append(waiting_, patch);
}

void Document::sent(std::uint32_t id, const Json& patch) {
    told_.push_back({id, patch, false});
}

void Document::moved(const Json& patch) {
    if (told_.empty())
        taken_.merge_patch(patch);
    else if (told_.back().id == 0)
        told_.back().patch.merge_patch(patch);
    else
        told_.push_back({0, patch, true});
}

void Document::answered(std::uint32_t id, bool taken) {
    const auto found = std::ranges::find(told_, id, &Told::id);
    if (id == 0 || found == told_.end()) return;
    if (taken)
        found->settled = true;
    else
        told_.erase(found);
    const auto open = std::ranges::find(told_, false, &Told::settled);
    for (auto told = told_.begin(); told != open; ++told) taken_.merge_patch(told->patch);
    told_.erase(told_.begin(), open);
}

void Document::lost() {
    std::vector<Json> all;
    for (const Told& told : told_) append(all, told.patch);
    for (const Json& patch : waiting_) append(all, patch);
    told_.clear();
    waiting_ = std::move(all);
}

std::vector<Json> Document::replay(const Json& has, const std::vector<std::string>& members) {
    Json ours = has;
    if (!members.empty())
        for (auto item = ours.begin(); item != ours.end();)
            item = std::ranges::find(members, item.key()) == members.end() ? ours.erase(item) : std::next(item);
    std::vector<Json> patches;
    if (Json patch = lacking(ours, taken_); !patch.empty()) patches.push_back(std::move(patch));
    for (Json& patch : std::exchange(waiting_, {})) patches.push_back(std::move(patch));
    taken_ = std::move(ours);
    return patches;
}

void Document::prune(const Json& resolved) {
    if (taken_.value("scene", Json{}) != resolved.value("scene", Json{})) return;
    for (const char* group : {"lights", "materials"}) {
        const auto mine = taken_.find(group);
        if (mine == taken_.end() || !mine->is_object()) continue;
        const Json known = resolved.value(group, Json::object());
        for (auto item = mine->begin(); item != mine->end();)
            item = known.contains(item.key()) ? std::next(item) : mine->erase(item);
    }
}

}  // namespace caustream::connection
