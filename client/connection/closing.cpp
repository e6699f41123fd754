#include "client/connection/closing.h"

#include "protocol/errors.h"

namespace caustream::connection {

Closing closingOf(int code, const std::string& reason) {
    switch (code) {
        case static_cast<int>(protocol::CloseCode::AuthRequired):
            return {false, "the server asks for its token, or does not take this one"};
        case static_cast<int>(protocol::CloseCode::Forbidden):
            return {false, "the server does not allow it (" + reason + ")"};
        case static_cast<int>(protocol::CloseCode::SessionTaken):
            return {false, "another viewer has taken this session over"};
        case static_cast<int>(protocol::CloseCode::Version):
            return {false, "the server speaks another version of the protocol"};
        case kBadCertificate:
            return {false, reason};
        case static_cast<int>(protocol::CloseCode::GoingAway):
            return {true, "the server is going away"};
        case static_cast<int>(protocol::CloseCode::Busy):
            return {true, "the server is busy"};
        default:
            return {true, reason};
    }
}

}  // namespace caustream::connection
