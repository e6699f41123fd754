// Error and close codes of the wire, and the error value every decoder returns.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace caustream::protocol {

enum class ErrorCode {
    // The connection may end with a close code of its own.
    BadMessage,  // not JSON, not an object, no op; a binary message whose header lies
    AuthRequired,
    Forbidden,
    Timeout,
    SessionTaken,
    Version,
    Busy,
    RateLimited,
    GpuError,
    TooLarge,
    Draining,
    // The connection always goes on.
    BadRequest,  // a field is missing or has the wrong type, or fields contradict each other
    OutOfRange,
    UnknownOp,
    UnknownField,  // only after hello.strict
    Unsupported,   // a choice this version does not know
    AssetInvalid,
    AssetMissing,
    BadOffset,
};

// The name on the wire, "bad_message"; and back, nothing for a name that is not one.
std::string_view errorName(ErrorCode code);
std::optional<ErrorCode> errorCodeOf(std::string_view name);

enum class CloseCode : std::uint16_t {
    GoingAway = 1001,
    TooLarge = 1009,
    BadMessage = 4400,
    AuthRequired = 4401,
    Forbidden = 4403,
    Timeout = 4408,
    SessionTaken = 4409,
    Version = 4426,
    Busy = 4429,
    GpuError = 4500,
};

// The close code that goes with an error, if the server ends the connection over it; nothing for those that never do.
std::optional<CloseCode> closeCodeOf(ErrorCode code);

struct DecodeError {
    ErrorCode code = ErrorCode::BadMessage;
    std::string message;              // one sentence
    std::string field;                // "camera.fov_y_deg", "camera.eye[1]"; empty: the whole message
    std::optional<std::uint32_t> id;  // of the request, where it could be read: the reply carries it
    bool operator==(const DecodeError&) const = default;
};

}  // namespace caustream::protocol
