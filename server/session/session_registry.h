// The sessions whose connections have ended, for clients that come back. Network thread only.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "protocol/patch.h"

namespace caustream::session {

// What a session is without its connection.
struct Kept {
    protocol::Json document = protocol::Json::object();
    std::uint32_t rev = 0, inputSeq = 0;
    std::uint64_t inputClientUs = 0;
};

class SessionRegistry {
   public:
    static constexpr std::size_t kMost = 256;  // of 32 KiB of text at the most; the one nearest to its end makes room

    void keep(const std::string& id, Kept kept, std::uint64_t untilUs);

    // The session is somebody's again.
    std::optional<Kept> take(const std::string& id);

    // By its own id or the one it is followed by; nothing once its time is over.
    const Kept* find(std::string_view idOrViewId) const;

    void sweep(std::uint64_t nowUs);
    std::size_t size() const { return kept_.size(); }

   private:
    struct Entry {
        Kept kept;
        std::string viewId;
        std::uint64_t untilUs;
    };
    std::map<std::string, Entry, std::less<>> kept_;
};

}  // namespace caustream::session
