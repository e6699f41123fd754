#include "protocol/errors.h"

#include <gtest/gtest.h>

#include <set>

namespace caustream::protocol {
namespace {

constexpr int kCodes = int(ErrorCode::BadOffset) + 1;

TEST(Errors, EveryCodeHasOneNameAndComesBack) {
    std::set<std::string_view> names;
    for (int i = 0; i < kCodes; ++i) {
        const std::string_view name = errorName(ErrorCode(i));
        EXPECT_FALSE(name.empty());
        EXPECT_TRUE(names.insert(name).second) << name;
        EXPECT_EQ(errorCodeOf(name), ErrorCode(i));
    }
    EXPECT_EQ(errorCodeOf("no_such_error"), std::nullopt);
    EXPECT_EQ(errorCodeOf(""), std::nullopt);
}

// libwebsockets sends 1012 to 1014 as 1002, so none of them may appear.
TEST(Errors, CloseCodesAreOnesThatTravel) {
    for (int i = 0; i < kCodes; ++i) {
        const auto close = closeCodeOf(ErrorCode(i));
        if (!close) continue;
        const int code = int(*close);
        EXPECT_TRUE(code == 1001 || code == 1009 || (code >= 4000 && code <= 4999)) << code;
    }
    EXPECT_EQ(closeCodeOf(ErrorCode::BadMessage), CloseCode::BadMessage);
    EXPECT_EQ(closeCodeOf(ErrorCode::RateLimited), CloseCode::Busy);
    for (ErrorCode stays :
         {ErrorCode::BadRequest, ErrorCode::OutOfRange, ErrorCode::UnknownOp, ErrorCode::UnknownField,
          ErrorCode::Unsupported, ErrorCode::AssetInvalid, ErrorCode::AssetMissing, ErrorCode::BadOffset})
        EXPECT_EQ(closeCodeOf(stays), std::nullopt) << errorName(stays);
}

}  // namespace
}  // namespace caustream::protocol
