// The document that a client keeps: whatever is lost on the way, the next server is told what the user wanted.
#include <gtest/gtest.h>

#include "client/connection/document.h"

namespace caustream::connection {
namespace {

Json parse(const char* text) {
    return Json::parse(text);
}

// What a server that has `document` makes of patches.
Json after(Json document, const std::vector<Json>& patches) {
    for (const Json& patch : patches) document.merge_patch(patch);
    return document;
}

TEST(Lacking, IsWhatOneDocumentSaysAndTheOtherDoesNot) {
    const Json wanted = parse(R"({"scene":["builtin","gem"],"camera":{"eye":[0,1,2]},"stream":{"width":512}})");
    EXPECT_EQ(lacking(Json::object(), wanted), wanted);
    EXPECT_EQ(lacking(wanted, wanted), Json::object());
    // A server adds defaults to what it was given; they stay.
    EXPECT_EQ(lacking(parse(R"({"camera":{"exposure":["auto"],"eye":[0,1,3]},"stream":{"width":512.0,"height":512},"materials":{}})"), wanted),
              parse(R"({"scene":["builtin","gem"],"camera":{"eye":[0,1,2]}})"));
}

TEST(Document, TakesOnlyWhatAServerTook) {
    Document document;
    document.sent(1, parse(R"({"scene":["builtin","prism"]})"));
    document.sent(2, parse(R"({"scene":["builtin","nowhere"]})"));
    EXPECT_EQ(document.wanted()["scene"][1], "nowhere");
    document.answered(1, true);
    document.answered(2, false);
    EXPECT_EQ(document.wanted()["scene"][1], "prism");
    EXPECT_EQ(document.taken(), document.wanted());
}

TEST(Document, WhatMovedAfterAChangeIsNotUndoneByIt) {
    Document document;
    document.moved(parse(R"({"camera":{"fov_y_deg":20}})"));
    document.sent(1, parse(R"({"scene":["builtin","prism"],"camera":null})"));
    document.moved(parse(R"({"camera":{"eye":[1,2,3]}})"));
    document.sent(2, parse(R"({"transport":{"bounces":3}})"));
    document.answered(2, true);
    document.answered(1, true);
    EXPECT_EQ(document.taken(),
              parse(R"({"scene":["builtin","prism"],"camera":{"eye":[1,2,3]},"transport":{"bounces":3}})"));
}

TEST(Document, GoesOnWhileNobodyIsThere) {
    Document document;
    document.sent(1, parse(R"({"scene":["builtin","sphere"],"lights":{"key":{"position":[0,2,0]}}})"));
    document.answered(1, true);
    document.sent(2, parse(R"({"transport":{"bounces":3}})"));
    document.lost();  // 2 was never answered
    document.keep(parse(R"({"scene":["builtin","prism"],"lights":null,"camera":null})"));
    document.keep(parse(R"({"lights":{"sun":{"direction":[0,-1,0]}}})"));
    document.keep(parse(R"({"lights":{"sun":{"direction":[1,-1,0]}}})"));
    document.lost();  // an attempt that failed
    const Json wanted = document.wanted();
    EXPECT_EQ(wanted, parse(R"({"scene":["builtin","prism"],"lights":{"sun":{"direction":[1,-1,0]}},"transport":{"bounces":3}})"));

    // To be resumed from: what is sure to be taken. What a server that knew the session had, or none, comes to the same.
    EXPECT_EQ(document.taken()["scene"][1], "sphere");
    for (const Json& has : {document.taken(), Json(Json::object())}) {
        Document copy = document;
        EXPECT_EQ(after(has, copy.replay(has)), wanted) << has;
        EXPECT_EQ(copy.taken(), has);
    }
}

TEST(Document, AnUploadedSceneIsPatchedBackIn) {
    Document document;
    document.sent(1, parse(R"({"scene":["asset","aa"],"materials":{"glass":{"dispersion":["constant",1.5]}},"stream":{"width":64}})"));
    document.answered(1, true);
    document.lost();
    const Json lacksIt = parse(R"({"stream":{"width":64}})");
    const auto patches = document.replay(lacksIt);
    ASSERT_EQ(patches.size(), 1u);
    EXPECT_EQ(patches[0], parse(R"({"scene":["asset","aa"],"materials":{"glass":{"dispersion":["constant",1.5]}}})"));
    document.sent(7, patches[0]);
    EXPECT_EQ(document.wanted()["scene"][1], "aa");
}

TEST(Document, AServerThatHasItAllIsToldNothing) {
    Document document;
    document.moved(parse(R"({"camera":{"eye":[1,2,3]}})"));
    document.lost();
    EXPECT_TRUE(document.replay(parse(R"({"camera":{"eye":[1.0,2.0,3.0]}})")).empty());
}

TEST(Document, AFollowerChangesOnlyWhatIsItsOwn) {
    Document document;
    document.moved(parse(R"({"camera":{"eye":[1,2,3]}})"));
    document.lost();
    const auto patches = document.replay(parse(R"({"scene":["builtin","gem"],"lights":{"key":{}},"camera":{"eye":[0,0,1]}})"),
                                         {"camera", "stream"});
    ASSERT_EQ(patches.size(), 1u);
    EXPECT_EQ(patches[0], parse(R"({"camera":{"eye":[1,2,3]}})"));
    EXPECT_FALSE(document.taken().contains("lights"));
}

TEST(Document, LosesWhatItsSceneLacks) {
    Document document;
    document.moved(parse(R"({"scene":["builtin","gem"],"lights":{"key":{},"of the scene before":{}},"materials":{"x":{}}})"));
    document.prune(parse(R"({"scene":["builtin","prism"],"lights":{}})"));
    EXPECT_EQ(document.wanted()["lights"].size(), 2u) << "it is of another scene";
    document.prune(parse(R"({"scene":["builtin","gem"],"lights":{"key":{"position":[0,1,0]}}})"));
    EXPECT_EQ(document.wanted(), parse(R"({"scene":["builtin","gem"],"lights":{"key":{}},"materials":{}})"));
}

}  // namespace
}  // namespace caustream::connection
