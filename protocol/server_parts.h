// The larger pieces of server messages.
#pragma once
#include "protocol/codec.h"

namespace caustream::protocol {

Limits decodeLimits(const Item& item);
SceneSummary decodeSceneSummary(const Item& item);
Ledger decodeLedger(const Item& item);

Json toJson(const Limits& limits);
Json toJson(const SceneSummary& scene);
Json toJson(const Ledger& ledger);

// Each element through `decodeOne`.
template <class T>
std::vector<T> decodeList(const Item& item, T (*decodeOne)(const Item&)) {
    std::vector<T> list;
    const std::size_t count = item.size(0, kListCount);
    list.reserve(count);
    for (std::size_t i = 0; i < count; ++i) list.push_back(decodeOne(item[i]));
    return list;
}

}  // namespace caustream::protocol
