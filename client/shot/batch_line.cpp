#include "client/shot/batch_line.h"

#include <algorithm>
#include <cctype>
#include <cstdio>

#include "protocol/json_text.h"

namespace caustream::shot {
namespace {

using protocol::Json;
using Wrong = tl::unexpected<LineError>;

constexpr std::size_t kLineBytes = 65536;  // as a server's default for a message
constexpr std::size_t kDepth = 31;         // the message around a patch is one level more
constexpr std::size_t kNameBytes = 100, kTargets = 32;

Wrong wrong(std::string field, std::string message) {
    return tl::make_unexpected(LineError{std::move(field), std::move(message)});
}

// A file's name on any system, hidden on none.
bool isName(const std::string& name) {
    return !name.empty() && name.size() <= kNameBytes && name.front() != '.' && std::ranges::all_of(name, [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '.' || c == '_' || c == '-';
    });
}

std::string numbered(int number) {
    char text[16];
    std::snprintf(text, sizeof text, "%06d", number);
    return text;
}

}  // namespace

tl::expected<BatchLine, LineError> parseBatchLine(std::string_view text, int number) {
    const auto json = protocol::parseText(text, kLineBytes, kDepth);
    if (!json) return wrong(json.error().field, json.error().message);
    if (!json->is_object()) return wrong("", "a line must be a JSON object, such as {\"patch\": {\"camera\": {\"eye\": [0, 1, 2]}}}");

    BatchLine line{.name = numbered(number), .patch = Json::object()};
    for (const auto& [key, value] : json->items()) {
        if (key == "name") {
            if (!value.is_string() || !isName(value.get_ref<const std::string&>()))
                return wrong("name", "must be a text of letters, digits, '.', '_' and '-' that can name a file");
            line.name = value;
        } else if (key == "patch") {
            if (!value.is_object()) return wrong("patch", "must be an object, a merge patch on the state document");
            line.patch = value;
        } else if (key == "targets") {
            if (!value.is_array() || value.empty() || value.size() > kTargets)
                return wrong("targets", "must be a list of names, such as [\"composite\", \"depth\"]");
            for (const Json& target : value) {
                const std::string field = "targets[" + std::to_string(line.targets.size()) + "]";
                if (!target.is_string()) return wrong(field, "must be a text");
                if (std::ranges::find(line.targets, target.get_ref<const std::string&>()) != line.targets.end())
                    return wrong(field, "is there twice");
                line.targets.push_back(target);
            }
        } else if (key == "converge") {
            if (!value.is_boolean()) return wrong("converge", "must be true or false");
            line.converge = value.get<bool>();
        } else {
            return wrong(key, "is not known; a line has name, patch, targets and converge, and the state document is its patch");
        }
    }
    if (const auto stream = line.patch.find("stream"); stream != line.patch.end() && stream->is_object()) {
        for (const auto& [key, value] : stream->items())
            if (key != "width" && key != "height")
                return wrong("patch.stream." + key, "is the batch's own; use targets, and --format");
    }
    return line;
}

Json lineDocument(const Json& start, const Json& patch) {
    Json document = start;
    if (patch.contains("scene") && patch["scene"] != start.value("scene", Json{})) {
        for (const char* ofThatScene : {"lights", "materials", "camera", "environment", "outside_index"}) document.erase(ofThatScene);
    }
    document.merge_patch(patch);
    return document;
}

Json patchBetween(const Json& from, const Json& to) {
    Json patch = Json::object();
    for (const auto& [key, value] : from.items())
        if (!to.contains(key)) patch[key] = nullptr;
    for (const auto& [key, value] : to.items()) {
        const auto before = from.find(key);
        if (before == from.end()) {
            patch[key] = value;
        } else if (before->is_object() && value.is_object()) {
            if (Json inner = patchBetween(*before, value); !inner.empty()) patch[key] = std::move(inner);
        } else if (*before != value) {
            patch[key] = value;
        }
    }
    return patch;
}

}  // namespace caustream::shot
