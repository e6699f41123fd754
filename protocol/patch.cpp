#include "protocol/patch.h"

#include <charconv>
#include <string>
#include <vector>

namespace caustream::protocol {
namespace {

tl::unexpected<DecodeError> bad(std::string_view path, std::string message, ErrorCode code = ErrorCode::BadRequest) {
    return tl::unexpected(DecodeError{code, std::move(message), std::string(path), std::nullopt});
}

bool deeperThan(const Json& value, std::size_t depth) {
    if (!value.is_structured()) return false;
    if (depth == 0) return true;
    for (const Json& child : value)
        if (deeperThan(child, depth - 1)) return true;
    return false;
}

// The segments of a path in either syntax.
tl::expected<std::vector<std::string>, DecodeError> split(std::string_view path) {
    const bool isPointer = path.starts_with('/');
    const char separator = isPointer ? '/' : '.';
    std::vector<std::string> segments(1);
    for (std::size_t i = isPointer ? 1 : 0; i < path.size(); ++i) {
        const char c = path[i];
        if (c == separator) {
            segments.emplace_back();
        } else if (isPointer && c == '~') {  // RFC 6901: ~0 is ~, ~1 is /
            const char next = ++i < path.size() ? path[i] : '\0';
            if (next != '0' && next != '1') return bad(path, "after ~ a JSON Pointer has 0 or 1");
            segments.back() += next == '0' ? '~' : '/';
        } else {
            segments.back() += c;
        }
    }
    for (const std::string& segment : segments)
        if (segment.empty()) return bad(path, "the path has an empty part");
    if (segments.size() > Limits{}.depth) return bad(path, "the path is too long");
    return segments;
}

// `array` with the element that segments[from...] names replaced.
tl::expected<Json, DecodeError> replaceElement(Json array, const std::vector<std::string>& segments, std::size_t from,
                                               std::string_view path, const Json& value) {
    Json* element = &array;
    for (std::size_t i = from; i < segments.size(); ++i) {
        std::size_t index = 0;
        const std::string& digits = segments[i];
        const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), index);
        const bool isIndex = parsed.ec == std::errc() && parsed.ptr == digits.data() + digits.size();
        if (!isIndex || !element->is_array()) return bad(path, "\"" + digits + "\" is not the index of an element");
        if (index >= element->size())
            return bad(path, "there are only " + std::to_string(element->size()) + " elements", ErrorCode::OutOfRange);
        element = &(*element)[index];
    }
    *element = value;
    return array;
}

}  // namespace

tl::expected<Applied, DecodeError> applyPatch(const Json& document, const Json& patch, const Limits& limits,
                                              bool strict) {
    if (!patch.is_object()) return bad({}, "a patch must be an object");
    if (deeperThan(patch, limits.depth)) return bad({}, "nested deeper than " + std::to_string(limits.depth));
    Json merged = document;
    merged.merge_patch(patch);
    auto state = decodeState(merged, limits, strict);
    if (!state) return tl::unexpected(std::move(state.error()));
    Json canonical = toJson(*state);
    if (canonical.dump(-1, ' ', false, Json::error_handler_t::replace).size() > limits.stateBytes)
        return bad({}, "the state document may have " + std::to_string(limits.stateBytes) + " bytes",
                   ErrorCode::TooLarge);
    return Applied{std::move(canonical), *std::move(state)};
}

tl::expected<Json, DecodeError> setPath(const Json& document, std::string_view path, const Json& value) {
    const auto segments = split(path);
    if (!segments) return tl::unexpected(segments.error());
    // Down through the document's objects, as far as it has them; an array there is replaced whole, as patches do.
    const Json* here = &document;
    std::size_t depth = 0;
    Json leaf = value;
    for (; depth < segments->size(); ++depth) {
        if (here && here->is_array()) {
            auto array = replaceElement(*here, *segments, depth, path, value);
            if (!array) return array;
            leaf = *std::move(array);
            break;
        }
        const auto member = here && here->is_object() ? here->find((*segments)[depth]) : Json::const_iterator();
        here = here && here->is_object() && member != here->end() ? &*member : nullptr;
    }
    for (; depth > 0; --depth) {
        Json parent = Json::object();
        parent[(*segments)[depth - 1]] = std::move(leaf);
        leaf = std::move(parent);
    }
    return leaf;
}

void extendPatch(Json& patch, const Json& next) {
    for (const auto& [name, value] : next.items()) {
        if (value.is_object() && patch.contains(name) && patch[name].is_object()) extendPatch(patch[name], value);
        else patch[name] = value;
    }
}

tl::expected<Setting, std::string> parseSetting(const std::string& text) {
    const auto equals = text.find('=');
    if (equals == 0 || equals == text.npos)
        return tl::make_unexpected("--set " + text + ": write PATH=VALUE, for example lights.key.position=[1,2,0]");
    const std::string value = text.substr(equals + 1);
    Json json = Json::parse(value, nullptr, false);
    if (json.is_discarded()) {
        if (value.find_first_of("[]{}\"") != value.npos)
            return tl::make_unexpected("--set " + text +
                                       ": the value is not JSON; quote it for the shell, 'path=[\"a\",1]'");
        json = value;
    }
    return Setting{text.substr(0, equals), std::move(json)};
}

tl::expected<Json, DecodeError> settingsPatch(const Json& document, const std::vector<Setting>& settings) {
    Json merged = document, patch = Json::object();
    for (const Setting& setting : settings) {
        const auto part = setPath(merged, setting.path, setting.value);
        if (!part) {
            DecodeError error = part.error();
            error.field = setting.path;
            return tl::unexpected(std::move(error));
        }
        merged.merge_patch(*part);
        extendPatch(patch, *part);
    }
    return patch;
}

Json sceneChange(const SceneRef& scene) {
    State shown;
    shown.scene = scene;
    return {{"scene", toJson(shown)["scene"]}, {"lights", nullptr},       {"materials", nullptr}, {"camera", nullptr},
            {"environment", nullptr},          {"outside_index", nullptr}};
}

}  // namespace caustream::protocol
