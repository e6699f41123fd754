// What both directions' codecs share.
#pragma once
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

#include "protocol/choices.h"
#include "protocol/json_text.h"

namespace caustream::protocol {

inline constexpr std::size_t kTextBytes = 512;  // identities, hints: short texts that people write
inline constexpr std::size_t kSentenceBytes = 4096;
inline constexpr std::size_t kListCount = 1u << 20;  // of a server's lists; the text's own limit comes first

template <class Message>
struct Op {
    std::string_view name;
    Message (*decode)(Fields& in);
};

// Text -> the variant `Message`, by the table of ops. The `id` is read first, so that every later error carries it.
template <class Message, std::size_t N>
tl::expected<Message, DecodeError> decodeByOp(std::string_view text, std::size_t maxBytes, std::size_t maxDepth,
                                              bool strict, const Op<Message> (&ops)[N]) {
    auto json = parseText(text, maxBytes, maxDepth);
    if (!json) return tl::unexpected(std::move(json.error()));
    const auto bad = [](ErrorCode code, const char* field, const char* message, std::optional<std::uint32_t> id = {}) {
        return tl::unexpected(DecodeError{code, message, field, id});
    };
    if (!json->is_object()) return bad(ErrorCode::BadMessage, "", "a message must be a JSON object");
    std::optional<std::uint32_t> id;
    if (const auto member = json->find("id"); member != json->end() && member->is_number_unsigned()) {
        const auto number = member->template get<std::uint64_t>();
        if (number >= 1 && number <= kMaxU32) id = static_cast<std::uint32_t>(number);
    }
    const auto op = json->find("op");
    if (op == json->end() || !op->is_string()) return bad(ErrorCode::BadMessage, "op", "must be a text", id);
    for (const Op<Message>& known : ops) {
        if (known.name != op->template get_ref<const std::string&>()) continue;
        Decoding decoding{strict, {}};
        const Item root(*json, decoding);
        Fields in(root);
        in.find("op");
        Message message = known.decode(in);
        in.finish();
        if (!decoding.error) return message;
        decoding.error->id = id;
        return tl::unexpected(*std::move(decoding.error));
    }
    return bad(ErrorCode::UnknownOp, "op", "is not known", id);
}

inline std::uint32_t requestId(Fields& in) {
    return in.at("id").u32(1);
}

template <class T>
void putOptional(Json& object, const char* key, const std::optional<T>& value) {
    if (value) object[key] = *value;
}

// Names that came from files may not be UTF-8: replaced, as a message must be.
inline std::string text(const Json& message) {
    return message.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace caustream::protocol
