// Text to JSON: what is refused, and that refusing is cheap.
#include "protocol/json_text.h"

#include <gtest/gtest.h>

#include <cfloat>

namespace caustream::protocol {
namespace {

constexpr std::size_t kBytes = 65536, kDepth = 32;

ErrorCode codeOf(std::string_view text) {
    const auto json = parseText(text, kBytes, kDepth);
    EXPECT_FALSE(json.has_value()) << text;
    return json ? ErrorCode::GpuError : json.error().code;
}

TEST(JsonText, ValuesComeOutAsTheyWentIn) {
    for (const char* text : {"null", "true", "-5", "18446744073709551615", "1.5", "\"x\"", "[]", "{}",
                             "[[],{},[1,[2]]]", R"({"a":{"b":[1,{"c":null}],"d":"e"},"f":[{"g":1},{"h":2}]})"}) {
        const auto json = parseText(text, kBytes, kDepth);
        ASSERT_TRUE(json.has_value()) << text;
        EXPECT_EQ(json->dump(), text);
    }
}

TEST(JsonText, WhatIsNotJsonIsRefused) {
    for (const char* text :
         {"",   " ",  "nul", "NaN", "Infinity", "-Infinity", "{\"a\":NaN}", "[1,]",  "{a:1}",   "{\"a\"}",  "'a'",
          "01", "+1", ".5",  "1.",  "0x10",     "\"\\x\"",   "\"\n\"",      "[1] 2", "// a\n1", "\xef\xbb", "\"\xff\""})
        EXPECT_EQ(codeOf(text), ErrorCode::BadMessage) << text;
    for (const std::string_view text : {std::string_view("1\0", 2), std::string_view("{}\0{", 4)})
        EXPECT_EQ(codeOf(text), ErrorCode::BadMessage);
}

TEST(JsonText, NumbersBeyondADoubleAreRefused) {
    for (const char* text : {"1e999", "-1e999", "[1e309]"}) {
        EXPECT_EQ(codeOf(text), ErrorCode::BadMessage);
        EXPECT_NE(parseText(text, kBytes, kDepth).error().message.find("range"), std::string::npos);
    }
    EXPECT_EQ(parseText("1.7976931348623157e308", kBytes, kDepth)->get<double>(), DBL_MAX);
}

TEST(JsonText, AKeyTwiceInOneObjectIsRefused) {
    EXPECT_EQ(codeOf(R"({"a":1,"b":2,"a":3})"), ErrorCode::BadMessage);
    EXPECT_EQ(codeOf(R"({"a":1,"\u0061":3})"), ErrorCode::BadMessage);
    EXPECT_TRUE(parseText(R"([{"a":1},{"a":{"a":2}}])", kBytes, kDepth).has_value());
}

TEST(JsonText, NestingIsBounded) {
    const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
    EXPECT_TRUE(parseText(nested(kDepth), kBytes, kDepth).has_value());
    EXPECT_EQ(codeOf(nested(kDepth + 1)), ErrorCode::BadMessage);
    EXPECT_EQ(codeOf(std::string(kBytes, '[')), ErrorCode::BadMessage);
    std::string objects;
    for (std::size_t i = 0; i < 5000; ++i) objects += "{\"a\":";
    EXPECT_EQ(codeOf(objects), ErrorCode::BadMessage);
}

TEST(JsonText, LengthIsBounded) {
    const std::string full = '"' + std::string(kBytes - 2, 'x') + '"';
    EXPECT_TRUE(parseText(full, kBytes, kDepth).has_value());
    EXPECT_EQ(codeOf(full + " "), ErrorCode::TooLarge);
}

}  // namespace
}  // namespace caustream::protocol
