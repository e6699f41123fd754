// What one viewer asked for: its state document, whole or not at all, with a revision, and the scene it names.
// Network thread only.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "protocol/patch.h"
#include "scene/scene.h"
#include "session/random_id.h"

namespace caustream::session {

// A change that decoded, and the scene with its lights and materials; commit() makes it so.
struct Proposal {
    protocol::Applied applied;
    std::shared_ptr<const scene::Scene> base;      // as the file has it
    std::shared_ptr<const scene::Scene> resolved;  // with the document's overrides
};

class Session {
   public:
    // `rev`: of the document that the first change will be made to.
    Session(std::string id, const protocol::Limits& limits, bool strict, std::uint32_t rev = 0)
        : id_(std::move(id)), viewId_(viewIdOf(id_)), limits_(limits), strict_(strict), rev_(rev) {}

    // The document with `patch` merged in, checked; this session is as before.
    tl::expected<protocol::Applied, protocol::DecodeError> apply(const protocol::Json& patch) const;

    // Checks `applied` against the scene it names. The resolved scene is the one before where nothing in it changed: the
    // renderer's cached light holds.
    tl::expected<Proposal, protocol::DecodeError> propose(protocol::Applied applied,
                                                          std::shared_ptr<const scene::Scene> base) const;

    // `document` in place of this session's, for the scene that another session has resolved from it.
    tl::expected<Proposal, protocol::DecodeError> adopt(const protocol::Json& document, const Session& from) const;

    // True if the scene is another one than before.
    bool commit(Proposal proposal);

    const std::string& id() const { return id_; }
    const std::string& viewId() const { return viewId_; }  // what others follow it by
    bool isNamed(std::string_view name) const { return name == id_ || name == viewId_; }
    std::uint32_t rev() const { return rev_; }
    const protocol::State& state() const { return current_.applied.state; }
    const protocol::Json& document() const { return current_.applied.document; }
    const std::shared_ptr<const scene::Scene>& base() const { return current_.base; }
    const std::shared_ptr<const scene::Scene>& resolved() const { return current_.resolved; }
    bool strict() const { return strict_; }

    // Of the newest input whose pose is in the document; 0: none.
    std::uint32_t inputSeq = 0;
    std::uint64_t inputClientUs = 0;

   private:
    std::string id_, viewId_;
    protocol::Limits limits_;
    bool strict_;
    std::uint32_t rev_;
    Proposal current_{.applied = {.document = protocol::Json::object()}};
};

}  // namespace caustream::session
