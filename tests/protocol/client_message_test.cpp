// What clients say: golden text, round trips, and every way a field can be wrong.
#include <gtest/gtest.h>

#include "samples.h"

namespace caustream::protocol {
namespace {

DecodeError errorOf(const std::string& text, bool strict = false) {
    const auto message = decodeClientMessage(text, {}, strict);
    EXPECT_FALSE(message.has_value()) << text;
    return message ? DecodeError{} : message.error();
}

TEST(ClientMessage, HasItsGoldenTextAndComesBackTheSame) {
    for (const auto& [message, text] : clientSamples()) {
        EXPECT_EQ(encode(message), text);
        const auto decoded = decodeClientMessage(text, {}, true);
        ASSERT_TRUE(decoded.has_value()) << text << ": " << decoded.error().field << " " << decoded.error().message;
        EXPECT_EQ(*decoded, message) << text;
    }
}

TEST(ClientMessage, SamplesCoverEveryAlternative) {
    std::vector<bool> seen(std::variant_size_v<ClientMessage>);
    for (const auto& sample : clientSamples()) seen[sample.message.index()] = true;
    EXPECT_EQ(std::count(seen.begin(), seen.end(), false), 0);
}

TEST(ClientMessage, EveryTruncationIsRefused) {
    for (const auto& sample : clientSamples())
        for (std::size_t length = 0; length < sample.text.size(); ++length)
            EXPECT_EQ(errorOf(sample.text.substr(0, length)).code, ErrorCode::BadMessage);
}

TEST(ClientMessage, MissingRequiredFieldIsNamed) {
    const auto tryWithout = [](const std::string& text, const std::string& field) {
        Json json = Json::parse(text);
        ASSERT_EQ(json.erase(field), 1u);
        const DecodeError error = errorOf(json.dump());
        EXPECT_EQ(error.code, ErrorCode::BadRequest) << json;
        EXPECT_EQ(error.field, field);
    };
    const auto& samples = clientSamples();
    for (const char* field : {"id", "client"}) tryWithout(samples[0].text, field);
    tryWithout(samples[1].text, "patch");
    for (const char* field : {"seq", "t_us"}) tryWithout(samples[3].text, field);
    for (std::size_t i : {4, 5, 6, 7}) tryWithout(samples[i].text, "id");
    for (const char* field : {"seq", "recv_us", "decode_us", "paint_us"}) tryWithout(samples[8].text, field);
    for (const char* field : {"id", "sha256", "size"}) tryWithout(samples[9].text, field);
    for (const char* field : {"id", "asset"}) tryWithout(samples[10].text, field);
    tryWithout(samples[11].text, "asset");
    for (const char* field : {"id", "on"}) tryWithout(samples[12].text, field);
    tryWithout(samples[13].text, "t_us");
}

TEST(ClientMessage, IntegersNeitherWrapNorTruncate) {
    const auto withSeq = [](const std::string& number) {
        return R"({"op":"ack","recv_us":0,"decode_us":0,"paint_us":0,"seq":)" + number + "}";
    };
    for (const char* wrong : {"-1", "0", "4294967296", "99999999999", "18446744073709551616", "1e300", "-0.0"}) {
        const DecodeError error = errorOf(withSeq(wrong));
        EXPECT_EQ(error.code, ErrorCode::OutOfRange) << wrong;
        EXPECT_EQ(error.field, "seq");
    }
    for (const char* wrong : {"1.5", "\"1\"", "true", "[1]", "{}", "null"})
        EXPECT_EQ(errorOf(withSeq(wrong)).code, ErrorCode::BadRequest) << wrong;
    for (const char* right : {"1", "1.0", "1e0", "4294967295"})
        EXPECT_TRUE(decodeClientMessage(withSeq(right)).has_value()) << right;
}

TEST(ClientMessage, TimesReachExactlyTo53Bits) {
    EXPECT_TRUE(decodeClientMessage(R"({"op":"ping","t_us":9007199254740991})").has_value());
    EXPECT_EQ(errorOf(R"({"op":"ping","t_us":9007199254740992})").code, ErrorCode::OutOfRange);
    EXPECT_EQ(errorOf(R"({"op":"ping","t_us":-1})").code, ErrorCode::OutOfRange);
}

TEST(ClientMessage, ErrorsCarryTheIdOfTheRequest) {
    EXPECT_EQ(errorOf(R"({"op":"update","id":7,"patch":5})").id, 7u);
    EXPECT_EQ(errorOf(R"({"op":"no.such","id":8})").id, 8u);
    EXPECT_EQ(errorOf(R"({"id":9})").id, 9u);
    for (const char* wrong : {"0", "-1", "1.5", "4294967296", "\"1\"", "null"})
        EXPECT_EQ(errorOf(R"({"op":"stream.pause","id":)" + std::string(wrong) + "}").id, std::nullopt) << wrong;
}

TEST(ClientMessage, TheSameIdTwiceInOneMessageIsRefused) {
    EXPECT_EQ(errorOf(R"({"op":"stream.pause","id":1,"id":2})").code, ErrorCode::BadMessage);
}

TEST(ClientMessage, UnknownOpsAndChoices) {
    EXPECT_EQ(errorOf(R"({"op":"update2"})").code, ErrorCode::UnknownOp);
    EXPECT_EQ(errorOf(R"({"op":"welcome"})").code, ErrorCode::UnknownOp) << "a server's op";
    EXPECT_EQ(errorOf(R"({"op":5})").code, ErrorCode::BadMessage);
    EXPECT_EQ(errorOf(R"({"id":1})").field, "op");
    for (const char* notAnObject : {"[]", "5", "\"op\"", "null", "true"})
        EXPECT_EQ(errorOf(notAnObject).code, ErrorCode::BadMessage);
    const DecodeError role = errorOf(R"({"op":"hello","id":1,"client":{"name":"x","version":""},"role":"king"})");
    EXPECT_EQ(role.code, ErrorCode::Unsupported);
    EXPECT_EQ(role.field, "role");
}

TEST(ClientMessage, UnknownFieldsMatterOnlyWhenStrict) {
    const std::string text = R"({"op":"ping","t_us":1,"colour":2})";
    EXPECT_TRUE(decodeClientMessage(text).has_value());
    const DecodeError error = errorOf(text, true);
    EXPECT_EQ(error.code, ErrorCode::UnknownField);
    EXPECT_EQ(error.field, "colour");
}

TEST(ClientMessage, StrictnessStartsWithItsHello) {
    const auto hello = [](const char* strict) {
        return R"({"op":"hello","id":1,"client":{"name":"x","version":"1","os":"y"},"strict":)" + std::string(strict) +
               "}";
    };
    EXPECT_TRUE(decodeClientMessage(hello("false")).has_value());
    EXPECT_EQ(errorOf(hello("true")).field, "client.os");
}

TEST(ClientMessage, HelloChecksItsRanges) {
    const auto hello = [](const std::string& field) {
        return R"({"op":"hello","id":1,"client":{"name":"x","version":"1"},)" + field + "}";
    };
    for (const char* right : {R"("max_inflight":1)", R"("max_inflight":8)", R"("caps":["never heard of"])"})
        EXPECT_TRUE(decodeClientMessage(hello(right)).has_value()) << right;
    for (const char* wrong : {R"("max_inflight":0)", R"("max_inflight":9)"})
        EXPECT_EQ(errorOf(hello(wrong)).code, ErrorCode::OutOfRange) << wrong;
    EXPECT_EQ(errorOf(hello(R"("caps":["jpeg",5])")).field, "caps[1]");
    EXPECT_EQ(errorOf(hello(R"("resume":{"session":""})")).field, "resume.session");
    EXPECT_EQ(errorOf(hello(R"("token":")" + std::string(513, 'x') + '"')).code, ErrorCode::OutOfRange);
}

TEST(ClientMessage, AssetsAreHashedInLowerCaseAndFit) {
    const auto begin = [](const std::string& hash, const std::string& size) {
        return R"({"op":"asset.begin","id":3,"sha256":")" + hash + R"(","size":)" + size + "}";
    };
    const std::string hash(64, '0');
    EXPECT_TRUE(decodeClientMessage(begin(hash, "67108864")).has_value());
    EXPECT_EQ(errorOf(begin(hash, "67108865")).code, ErrorCode::TooLarge);
    EXPECT_EQ(errorOf(begin(hash, "67108865")).id, 3u);
    EXPECT_EQ(errorOf(begin(hash, "0")).code, ErrorCode::OutOfRange);
    EXPECT_EQ(errorOf(begin(std::string(63, '0'), "1")).field, "sha256");
    EXPECT_EQ(errorOf(begin(std::string(64, 'A'), "1")).field, "sha256");
}

}  // namespace
}  // namespace caustream::protocol
