#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "protocol/json_text.h"
#include "protocol/messages.h"
#include "protocol/patch.h"
#include "targets.h"

namespace caustream::fuzz {
namespace {

using namespace protocol;

std::string_view textOf(Bytes bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

void requireComplete(const DecodeError& error) {
    require(!errorName(error.code).empty() && !error.message.empty(), "an error has a name and a sentence");
}

// What is understood can be said again, and what is said can be refused without harm.
template <class Decode, class Encode>
void decodeBothWays(std::string_view text, const Decode& decode, const Encode& encode) {
    for (const bool strict : {false, true}) {
        const auto message = decode(text, strict);
        if (message) {
            const auto again = decode(encode(*message), true);
            require(again.has_value() && *again == *message, "a decoded message, encoded, decodes to itself");
        } else {
            requireComplete(message.error());
        }
    }
}

}  // namespace

void require(bool kept, const char* promise) {
    if (!kept) {
        std::fprintf(stderr, "broken: %s\n", promise);
        std::abort();
    }
}

void clientText(Bytes text) {
    decodeBothWays(
        textOf(text), [](std::string_view t, bool strict) { return decodeClientMessage(t, {}, strict); },
        [](const ClientMessage& message) { return encode(message); });
}

void serverText(Bytes text) {
    decodeBothWays(
        textOf(text), [](std::string_view t, bool strict) { return decodeServerMessage(t, {}, strict); },
        [](const ServerMessage& message) { return encode(message); });
}

void patches(Bytes text) {
    const auto parsed = parseText(textOf(text), text.size(), Limits{}.depth);
    if (!parsed) {
        requireComplete(parsed.error());
        return;
    }
    Json document = Json::object();
    for (const Json& patch : parsed->is_array() ? *parsed : Json::array({*parsed})) {
        const auto applied = applyPatch(document, patch);
        if (!applied) {
            requireComplete(applied.error());
            continue;
        }
        const auto decoded = decodeState(applied->document, {}, true);
        require(decoded && *decoded == applied->state, "the document that is kept decodes to the state");
        const auto same = applyPatch(applied->document, Json::object(), {}, true);
        require(same && same->document == applied->document, "an empty patch changes nothing");
        document = applied->document;
    }
}

void headers(Bytes message) {
    const auto frame = decodeFrameHeader(message);
    const auto chunk = decodeChunkHeader(message);
    require(!frame || !chunk, "no message is both a frame and a chunk");
    const auto check = [&](const auto& header, const auto& decode) {
        if (!header) {
            requireComplete(header.error());
            return;
        }
        require(std::size_t{header->headerLen} + header->payloadLen == message.size(), "header and payload are the message");
        auto known = *header;
        const auto start = encodeHeader(known);
        known.headerLen = static_cast<std::uint16_t>(start.size());
        std::vector<std::uint8_t> again(start.begin(), start.end());
        again.insert(again.end(), message.end() - header->payloadLen, message.end());
        const auto decoded = decode(again);
        require(decoded && *decoded == known, "a decoded header, encoded, decodes to itself");
    };
    check(frame, [](Bytes bytes) { return decodeFrameHeader(bytes); });
    check(chunk, [](Bytes bytes) { return decodeChunkHeader(bytes); });
}

}  // namespace caustream::fuzz
