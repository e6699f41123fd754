#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "mutators.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t maxSize);

namespace caustream::fuzz {
namespace {

using nlohmann::json;

const json kStrange[] = {nullptr, true, -1, 0, 1, 2, 3, 16, 255, 65536, 4294967295u, 4294967296, 9007199254740992, 1e300, -1e300,
                         1e-300, 0.5, 380, 680, "", "x", "E", "none", json::array(), json::object(), {0, 0, 0}, {1, 2, 3}};

std::string mutateBytes(std::string text, std::size_t maxSize) {
    const std::size_t size = std::min(text.size(), maxSize);
    text.resize(maxSize);
    text.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(text.data()), size, maxSize));
    return text;
}

// The library's destructor and dump recurse.
bool shallow(const std::string& text) {
    return std::ranges::count(text, '[') + std::ranges::count(text, '{') < 5000;
}

void collect(json& value, std::vector<json*>& nodes) {
    nodes.push_back(&value);
    if (value.is_structured()) {
        for (json& child : value) {
            collect(child, nodes);
        }
    }
}

void bendNumber(json& value, std::mt19937& dice) {
    const double number = value.get<double>();
    switch (dice() % 5) {
        case 0:
            value = number + 1;
            break;
        case 1:
            value = number - 1;
            break;
        case 2:
            value = -number;
            break;
        case 3:
            value = static_cast<std::int64_t>(dice());
            break;
        default: {
            double bits = number;
            LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(&bits), sizeof bits, sizeof bits);
            value = bits;
        }
    }
}

void bendChildren(json& value, const json& other, std::mt19937& dice) {
    const bool erase = !value.empty() && dice() % 2 == 0;
    if (value.is_array()) {
        const auto at = value.begin() + static_cast<std::ptrdiff_t>(value.empty() ? 0 : dice() % value.size());
        erase ? value.erase(at) : value.insert(at, other);
    } else if (erase) {
        value.erase(std::next(value.begin(), static_cast<std::ptrdiff_t>(dice() % value.size())));
    } else if (other.is_object()) {
        value.update(other);
    } else {
        value[other.is_string() ? other.get<std::string>() : "extras"] = other;
    }
}

}  // namespace

std::string mutateJson(const std::string& text, std::size_t maxSize, std::mt19937& dice) {
    if (dice() % 4 == 0 || !shallow(text)) {
        return mutateBytes(text, maxSize);
    }
    json root = json::parse(text, nullptr, false);
    if (root.is_discarded()) {
        return mutateBytes(text, maxSize);
    }
    for (unsigned hits = 1 + dice() % 3; hits > 0; --hits) {
        std::vector<json*> nodes;
        collect(root, nodes);
        json& node = *nodes[dice() % nodes.size()];
        const json other = dice() % 2 ? kStrange[dice() % std::size(kStrange)] : *nodes[dice() % nodes.size()];
        if (node.is_number() && dice() % 2) {
            bendNumber(node, dice);
        } else if (node.is_string() && dice() % 3 == 0) {
            node = mutateBytes(node.get<std::string>(), node.get<std::string>().size() + 8);
        } else if (node.is_structured() && dice() % 3) {
            bendChildren(node, other, dice);
        } else {
            node = other;
        }
    }
    std::string changed = root.dump(-1, ' ', false, json::error_handler_t::replace);
    return changed.size() <= maxSize ? changed : mutateBytes(text, maxSize);
}

}  // namespace caustream::fuzz
