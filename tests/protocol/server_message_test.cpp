// What the server says: golden text, round trips, and clients that do not trust it.
#include <gtest/gtest.h>

#include <limits>

#include "samples.h"

namespace caustream::protocol {
namespace {

TEST(ServerMessage, HasItsGoldenTextAndComesBackTheSame) {
    for (const auto& [message, text] : serverSamples()) {
        EXPECT_EQ(encode(message), text);
        const auto decoded = decodeServerMessage(text, {}, true);
        ASSERT_TRUE(decoded.has_value()) << text << ": " << decoded.error().field << " " << decoded.error().message;
        EXPECT_EQ(*decoded, message) << text;
    }
}

TEST(ServerMessage, SamplesCoverEveryAlternative) {
    std::vector<bool> seen(std::variant_size_v<ServerMessage>);
    for (const auto& sample : serverSamples()) seen[sample.message.index()] = true;
    EXPECT_EQ(std::count(seen.begin(), seen.end(), false), 0);
}

TEST(ServerMessage, EveryTruncationIsRefused) {
    for (const auto& sample : serverSamples())
        for (std::size_t length = 0; length < sample.text.size(); ++length)
            EXPECT_FALSE(decodeServerMessage(sample.text.substr(0, length)).has_value());
}

// Every member of every sample, replaced by a value of another type, is refused with its name.
TEST(ServerMessage, WrongTypesAreNamed) {
    for (const auto& sample : serverSamples()) {
        const Json whole = Json::parse(sample.text);
        for (const auto& [key, value] : whole.items()) {
            Json broken = whole;
            broken[key] = value.is_boolean() ? Json("yes") : Json(true);
            const auto decoded = decodeServerMessage(broken.dump());
            ASSERT_FALSE(decoded.has_value()) << broken;
            EXPECT_EQ(decoded.error().field, key);
        }
    }
}

TEST(ServerMessage, AnErrorOfEveryCodeComesBack) {
    for (int i = 0; i <= int(ErrorCode::BadOffset); ++i) {
        const ErrorMessage error{1, ErrorCode(i), "m"};
        const auto decoded = decodeServerMessage(encode(error));
        ASSERT_TRUE(decoded.has_value()) << encode(error);
        EXPECT_EQ(std::get<ErrorMessage>(*decoded), error);
    }
    EXPECT_EQ(decodeServerMessage(R"({"op":"error","code":"tired","message":"","fatal":false})").error().code,
              ErrorCode::Unsupported);
}

TEST(ServerMessage, ADecodeErrorBecomesAReply) {
    const ErrorMessage reply = errorMessage({ErrorCode::OutOfRange, "too far", "camera.eye", 5});
    EXPECT_EQ(reply, (ErrorMessage{5, ErrorCode::OutOfRange, "too far", "camera.eye", false, {}}));
    EXPECT_EQ(errorMessage({ErrorCode::BadMessage, "", "", {}}, true).field, std::nullopt);
}

TEST(ServerMessage, NamesThatAreNotUtf8AreReplacedNotThrown) {
    StateMessage state;
    state.scene.name = "bad \xff name";
    const auto decoded = decodeServerMessage(encode(state));
    ASSERT_TRUE(decoded.has_value());
    EXPECT_EQ(std::get<StateMessage>(*decoded).scene.name, "bad \xef\xbf\xbd name");
}

TEST(ServerMessage, ANumberThatIsNoneIsRefusedByTheReader) {
    Stats stats;
    stats.renderMs = std::numeric_limits<double>::quiet_NaN();
    const auto decoded = decodeServerMessage(encode(stats));
    ASSERT_FALSE(decoded.has_value());
    EXPECT_EQ(decoded.error().field, "render_ms");
}

TEST(ServerMessage, TextOverTheLimitIsNotParsed) {
    const Limits limits{.serverTextBytes = 40};
    EXPECT_EQ(decodeServerMessage(std::string(41, '['), limits).error().code, ErrorCode::TooLarge);
}

}  // namespace
}  // namespace caustream::protocol
