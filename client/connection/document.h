// The state document as this client wants it: what a server has taken, and what one has still to hear. Pure.
#pragma once
#include <cstdint>
#include <vector>

#include "protocol/patch.h"

namespace caustream::connection {

using protocol::Json;

// The merge patch (RFC 7396) of all that `wanted` says and `has` does not; empty when it says it all.
Json lacking(const Json& has, const Json& wanted);

class Document {
 public:
    // All that was asked for, without what a server refused.
    Json wanted() const;
    // What a server has taken, to be resumed from.
    const Json& taken() const { return taken_; }

    void keep(const Json& patch);                     // nobody is there to be told
    void sent(std::uint32_t id, const Json& patch);   // told; the answer has this id
    void moved(const Json& patch);                    // told, and there will be no answer
    void answered(std::uint32_t id, bool taken);
    void lost();  // the connection broke: what was not answered has still to be heard

    // A server is there and has the document `has`: that which it was given, or part of it; of which only `members` are ours to change (empty: all). What to
    // tell it, in this order, each with sent().
    std::vector<Json> replay(const Json& has, const std::vector<std::string>& members = {});

    // `resolved`: the server's document with the file's values. A light or material that this scene lacks would make
    // the next server refuse all the rest.
    void prune(const Json& resolved);

 private:
    struct Told {
        std::uint32_t id = 0;  // 0: what moved
        Json patch;
        bool settled = false;  // taken; applied once all that was told before it is
    };

    Json taken_ = Json::object();
    std::vector<Told> told_;     // since the oldest that has no answer yet
    std::vector<Json> waiting_;  // patches with their nulls, for the next server
};

}  // namespace caustream::connection
