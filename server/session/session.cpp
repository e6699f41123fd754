#include "session/session.h"

#include <utility>

#include "session/scene_overrides.h"

namespace caustream::session {
namespace {

bool sameOverrides(const protocol::State& a, const protocol::State& b) {
    return a.lights == b.lights && a.materials == b.materials && a.environmentColor == b.environmentColor &&
           a.outsideIndex == b.outsideIndex;
}

}  // namespace

tl::expected<protocol::Applied, protocol::DecodeError> Session::apply(const protocol::Json& patch) const {
    return protocol::applyPatch(document(), patch, limits_, strict_);
}

tl::expected<Proposal, protocol::DecodeError> Session::propose(protocol::Applied applied,
                                                               std::shared_ptr<const scene::Scene> base) const {
    if (base == current_.base && current_.resolved && sameOverrides(applied.state, state())) {
        return Proposal{std::move(applied), std::move(base), current_.resolved};
    }
    auto resolved = withOverrides(*base, applied.state);
    if (!resolved) {
        return tl::unexpected(std::move(resolved.error()));
    }
    return Proposal{std::move(applied), std::move(base), std::make_shared<const scene::Scene>(std::move(*resolved))};
}

tl::expected<Proposal, protocol::DecodeError> Session::adopt(const protocol::Json& document, const Session& from) const {
    auto applied = protocol::applyPatch(protocol::Json::object(), document, limits_);
    if (!applied) {
        return tl::unexpected(std::move(applied.error()));
    }
    return Proposal{std::move(*applied), from.base(), from.resolved()};
}

bool Session::commit(Proposal proposal) {
    const bool otherScene = proposal.base != current_.base;
    current_ = std::move(proposal);
    ++rev_;
    return otherScene;
}

}  // namespace caustream::session
