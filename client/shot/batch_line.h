// One line of a batch file, as it is written; nothing of it has been tried yet. docs/batch.md has the format.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "protocol/state.h"

namespace caustream::shot {

struct BatchLine {
    std::string name;                  // of its files; unique in a batch
    protocol::Json patch;              // merge patch on the document that the batch starts with
    std::vector<std::string> targets;  // empty: the batch's
    std::optional<bool> converge;      // nothing: as the batch
    bool operator==(const BatchLine&) const = default;
};

struct LineError {
    std::string field, message;  // "patch.stream.target", a sentence
    std::string text() const { return field.empty() ? message : field + ": " + message; }
};

// `number`, from 1, names a line that has no name. Never throws.
tl::expected<BatchLine, LineError> parseBatchLine(std::string_view text, int number);

// The document that a line shows: `start` with its patch merged in. Another scene begins as its file has it.
protocol::Json lineDocument(const protocol::Json& start, const protocol::Json& patch);

// The merge patch that makes `to` of `from`, as small as it can be.
protocol::Json patchBetween(const protocol::Json& from, const protocol::Json& to);

}  // namespace caustream::shot
