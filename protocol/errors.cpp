#include "protocol/errors.h"

#include <array>
#include <utility>

namespace caustream::protocol {
namespace {

struct Row {
    ErrorCode code;
    std::string_view name;
    std::optional<CloseCode> close;
};

constexpr std::array kRows = {
    Row{ErrorCode::BadMessage, "bad_message", CloseCode::BadMessage},
    Row{ErrorCode::AuthRequired, "auth_required", CloseCode::AuthRequired},
    Row{ErrorCode::Forbidden, "forbidden", CloseCode::Forbidden},
    Row{ErrorCode::Timeout, "timeout", CloseCode::Timeout},
    Row{ErrorCode::SessionTaken, "session_taken", CloseCode::SessionTaken},
    Row{ErrorCode::Version, "version", CloseCode::Version},
    Row{ErrorCode::Busy, "busy", CloseCode::Busy},
    Row{ErrorCode::RateLimited, "rate_limited", CloseCode::Busy},
    Row{ErrorCode::GpuError, "gpu_error", CloseCode::GpuError},
    Row{ErrorCode::TooLarge, "too_large", CloseCode::TooLarge},
    Row{ErrorCode::Draining, "draining", CloseCode::GoingAway},
    Row{ErrorCode::BadRequest, "bad_request", std::nullopt},
    Row{ErrorCode::OutOfRange, "out_of_range", std::nullopt},
    Row{ErrorCode::UnknownOp, "unknown_op", std::nullopt},
    Row{ErrorCode::UnknownField, "unknown_field", std::nullopt},
    Row{ErrorCode::Unsupported, "unsupported", std::nullopt},
    Row{ErrorCode::AssetInvalid, "asset_invalid", std::nullopt},
    Row{ErrorCode::AssetMissing, "asset_missing", std::nullopt},
    Row{ErrorCode::BadOffset, "bad_offset", std::nullopt},
};

}  // namespace

std::string_view errorName(ErrorCode code) {
    for (const Row& row : kRows)
        if (row.code == code) return row.name;
    return {};
}

std::optional<ErrorCode> errorCodeOf(std::string_view name) {
    for (const Row& row : kRows)
        if (row.name == name) return row.code;
    return std::nullopt;
}

std::optional<CloseCode> closeCodeOf(ErrorCode code) {
    for (const Row& row : kRows)
        if (row.code == code) return row.close;
    return std::nullopt;
}

}  // namespace caustream::protocol
