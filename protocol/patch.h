// Changing the state document: RFC 7396 merge patches, applied whole or not at all.
#pragma once
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "protocol/state.h"

namespace caustream::protocol {

struct Applied {
    Json document;  // of `state`, canonical: what the decoder does not know is not kept
    State state;
};

// `document` with `patch` merged in; `document` itself is never touched. A tagged array is replaced whole; null takes a
// member out, which brings the default or the file's value back.
tl::expected<Applied, DecodeError> applyPatch(const Json& document, const Json& patch, const Limits& limits = {},
                                              bool strict = false);

// The patch that sets one value. `path` is dotted ("lights.key.position") or, where it starts with '/', a JSON Pointer
// ("/lights/lamp.001/position"). A number picks one element of an array that `document` holds.
tl::expected<Json, DecodeError> setPath(const Json& document, std::string_view path, const Json& value);

// Makes `patch` change what `next` changes too. Unlike merging into a document, this keeps null.
void extendPatch(Json& patch, const Json& next);

// One change as a command line has it, "a.b=VALUE". VALUE is JSON; what is not JSON is a string, so that words need no
// quotes. The error is a sentence.
struct Setting {
    std::string path;  // dotted, or a JSON Pointer
    Json value;
};
tl::expected<Setting, std::string> parseSetting(const std::string& text);

// The patch of all `settings`, one after the other; `document` has the arrays whose elements they name.
tl::expected<Json, DecodeError> settingsPatch(const Json& document, const std::vector<Setting>& settings);

// The patch that shows another scene as its file has it: the overrides made for the one before go.
Json sceneChange(const SceneRef& scene);

}  // namespace caustream::protocol
