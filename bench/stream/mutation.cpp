#include "bench/stream/mutation.h"

#include <zlib.h>

#include <array>
#include <iterator>

#include "protocol/frame_header.h"
#include "protocol/patch.h"
#include "tests/protocol/samples.h"

namespace caustream::bench {
namespace {

// What decoders trip over.
const std::string kSplinters[] = {"null", "-1", "1e999", "1.5", "[]", "{}", "\"\"", "true", "NaN", "4294967296", "0", "[[[[", "}}}}", "\\u0",
                                  "\\ud800", "\"", "\xc3", ",", ":", "1e308", "-0.0", "18446744073709551616", "\"op\":", "\"id\":",
                                  std::string("\0", 1), std::string(200, '['), R"("scene":["asset","x"])", R"({"lights":null})"};

std::uint32_t little(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
    return value;
}

void putLittle(std::string& bytes, std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (8 * i));
}

}  // namespace

std::string damagedText(std::string text, Dice& dice) {
    for (std::size_t hits = 1 + dice.below(3); hits > 0; --hits) {
        const std::size_t at = dice.below(text.size() + 1), length = dice.below(12);
        const std::string& splinter = kSplinters[dice.below(std::size(kSplinters))];
        switch (dice.below(6)) {
            case 0:
                if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << dice.below(7)));
                break;
            case 1: text.erase(at, length); break;
            case 2: text.insert(at, splinter); break;
            case 3: text.replace(at, length, splinter); break;
            case 4: text.resize(at); break;
            default: text.insert(at, text.substr(dice.below(text.size() + 1), length));
        }
    }
    return text;
}

std::string damagedValues(const std::string& text, Dice& dice) {
    using protocol::Json;
    static const std::vector<Json> kStrange = {nullptr, -1,          0,  1.5, 1e300,         -1e-300, 4294967296, 9007199254740992, "", "x", std::string(300, 'n'), true,
                                               Json::array(), Json::object(), {1, 2, 3}, {"E"}, {"builtin", "gem"}, 512, {nullptr}, Json::array({1e308, 1e308, 1e308})};
    const Json whole = Json::parse(text);
    const Json flat = whole.flatten();
    Json damaged = whole;
    for (std::size_t hits = 1 + dice.below(2); hits > 0; --hits) {
        auto leaf = flat.begin();
        std::advance(leaf, static_cast<std::ptrdiff_t>(dice.below(flat.size())));
        try {
            damaged[Json::json_pointer(leaf.key())] = kStrange[dice.below(kStrange.size())];
        } catch (const Json::exception&) {   // the first hit took the place of the second
        }
    }
    return damaged.dump();
}

std::string damagedBytes(std::string bytes, Dice& dice) {
    constexpr std::array<std::uint32_t, 6> kNumbers = {0, 1, 0x7fffffff, 0x80000000, 0xffffffff, 0x00040001};
    for (std::size_t hits = 1 + dice.below(3); hits > 0; --hits) {
        if (bytes.size() < 4) return bytes;
        const std::size_t at = dice.below(bytes.size() - 3);
        switch (dice.below(5)) {
            case 0: bytes[at] = static_cast<char>(bytes[at] ^ (1 << dice.below(8))); break;
            case 1: putLittle(bytes, at, kNumbers[dice.below(kNumbers.size())]); break;
            case 2: bytes.resize(at); break;
            case 3: bytes.insert(at, bytes.substr(dice.below(bytes.size()), dice.below(64))); break;
            default: bytes.erase(at, dice.below(16));
        }
    }
    return bytes;
}

std::string damagedGlb(const std::string& glb, Dice& dice) {
    constexpr std::size_t kJsonAt = 20;
    const std::size_t jsonSize = little(glb, 12);
    std::string head = glb.substr(0, kJsonAt), json = glb.substr(kJsonAt, jsonSize), rest = glb.substr(kJsonAt + jsonSize);
    switch (dice.below(4)) {
        case 0: return damagedBytes(glb.substr(0, 64), dice) + glb.substr(64);
        case 1: rest = damagedBytes(rest, dice); break;
        default: json = damagedText(json, dice);
    }
    // A container that is right again lets the damage through to what reads the scene.
    if (dice.below(4) != 0) {
        json.resize((json.size() + 3) / 4 * 4, ' ');
        putLittle(head, 12, static_cast<std::uint32_t>(json.size()));
        putLittle(head, 8, static_cast<std::uint32_t>(kJsonAt + json.size() + rest.size()));
    }
    return head + json + rest;
}

const std::vector<std::string>& validMessages() {
    static const std::vector<std::string> messages = [] {
        std::vector<std::string> texts;
        for (const auto& sample : protocol::clientSamples()) texts.push_back(sample.text);
        texts.push_back(protocol::encode(protocol::Update{3, protocol::toJson(protocol::fullState())}));
        return texts;
    }();
    return messages;
}

std::string validChunk(std::uint32_t asset, std::uint64_t offset, const std::string& payload) {
    protocol::ChunkHeader header{.asset = asset, .offset = offset, .payloadLen = static_cast<std::uint32_t>(payload.size())};
    header.crc32 = static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(payload.data()), static_cast<uInt>(payload.size())));
    const auto head = protocol::encodeHeader(header);
    return std::string(head.begin(), head.end()) + payload;
}

}  // namespace caustream::bench
