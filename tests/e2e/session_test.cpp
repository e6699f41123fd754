// Sessions that outlive their connections, change hands, and are followed by others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include "raw_client.h"
#include "server_process.h"

namespace caustream::e2e {
namespace {

const Json kSmall = {{"transport", {{"mode", "refined"}, {"photon_grid", 64}, {"map_size", 64}}},
                     {"stream", {{"width", 96}, {"height", 64}, {"max_fps", 240}}}};

Json lightAt(double x) { return {{"lights", {{"key", {{"position", {x, 4.0, 0.5}}, {"direction", {-x, -4.0, -0.5}}}}}}}; }
Json eyeAt(double x) { return {{"camera", {{"eye", {x, 1.0, 3.0}}}}}; }

class Sessions : public testing::Test {
   protected:
    ServerProcess server_;
};

TEST_F(Sessions, AreTakenUpAgainWhereTheyWereLeft) {
    std::string session;
    std::uint32_t rev = 0;
    {
        RawClient viewer(server_.port());
        session = viewer.hello()["session"];
        viewer.update(kSmall);
        rev = viewer.update(lightAt(0.25))["rev"];
    }
    RawClient again(server_.port());
    const Json welcome = again.hello({{"resume", {{"session", session}}}});
    EXPECT_EQ(welcome["session"], session);
    EXPECT_EQ(welcome["resumed"], true);
    EXPECT_GT(welcome["rev"], rev) << "a client may tell its document from an older one";
    EXPECT_EQ(welcome["state"]["lights"]["key"]["position"][0], 0.25);
    EXPECT_EQ(welcome["state"]["stream"]["width"], 96);
}

TEST_F(Sessions, TheClientsDocumentIsAtLeastAsNew) {
    std::string session;
    {
        RawClient viewer(server_.port());
        session = viewer.hello()["session"];
        viewer.update(kSmall);
    }
    Json mine = kSmall;
    mine["camera"] = {{"fov_y_deg", 33.0}};
    RawClient again(server_.port());
    const Json welcome = again.hello({{"resume", {{"session", session}, {"state", mine}, {"rev", 41}}}});
    EXPECT_EQ(welcome["state"]["camera"]["fov_y_deg"], 33.0);
    EXPECT_GT(welcome["rev"], 41);
}

TEST_F(Sessions, AnUnknownOneStartsUnderItsOwnName) {
    const std::string id = "00112233445566778899aabbccddeeff";
    RawClient viewer(server_.port());
    const Json welcome = viewer.hello({{"resume", {{"session", id}, {"state", kSmall}}}});
    EXPECT_EQ(welcome["session"], id);
    EXPECT_EQ(welcome["resumed"], false);
    RawClient other(server_.port());
    EXPECT_NE(other.hello({{"resume", {{"session", "mine"}}}})["session"], "mine") << "that could be guessed";
}

TEST_F(Sessions, AHelloThatFailsLosesNothing) {
    std::string session;
    {
        RawClient viewer(server_.port());
        session = viewer.hello()["session"];
        viewer.update(lightAt(0.25));
    }
    RawClient again(server_.port());
    again.json({{"op", "hello"}, {"id", 1}, {"client", {{"name", "t"}, {"version", "1"}}}, {"resume", {{"session", session}, {"state", {{"scene", 7}}}}}});
    const auto error = again.textOf("error");
    ASSERT_TRUE(error);
    EXPECT_EQ((*error)["field"], "scene");
    EXPECT_EQ(again.hello({{"resume", {{"session", session}}}})["state"]["lights"]["key"]["position"][0], 0.25);
}

TEST_F(Sessions, GoToTheConnectionThatAskedLast) {
    RawClient first(server_.port());
    const std::string session = first.hello()["session"];
    first.update(lightAt(0.5));
    RawClient second(server_.port());
    const Json welcome = second.hello({{"resume", {{"session", session}}}});
    EXPECT_EQ(welcome["resumed"], true);
    EXPECT_EQ(welcome["state"]["lights"]["key"]["position"][0], 0.5);
    const auto goaway = first.textOf("goaway");
    ASSERT_TRUE(goaway);
    EXPECT_EQ((*goaway)["reason"], "takeover");
    Message end = first.next();
    while (end.kind == Message::Kind::Text || end.kind == Message::Kind::Binary) {
        end = first.next();
    }
    EXPECT_EQ(end.kind, Message::Kind::Close);
    EXPECT_EQ(end.closeCode, 4409);
    EXPECT_EQ(second.update(kSmall)["op"], "ok") << "and it goes on";
}

TEST_F(Sessions, AViewShowsWhatAnotherDoesWithACameraOfItsOwn) {
    RawClient teacher(server_.port());
    const std::string viewId = teacher.hello()["view_id"];
    teacher.update(kSmall);
    teacher.update(lightAt(0.25));

    RawClient pupil(server_.port());
    const Json welcome = pupil.hello({{"role", "view"}, {"follow", viewId}});
    EXPECT_EQ(welcome["state"]["lights"]["key"]["position"][0], 0.25);
    EXPECT_EQ(welcome["state"]["transport"]["photon_grid"], 64);
    EXPECT_EQ(pupil.update(eyeAt(2.0))["op"], "ok");
    EXPECT_EQ(pupil.update({{"stream", kSmall["stream"]}})["op"], "ok");

    for (const Json& patch : {lightAt(0.0), Json{{"scene", {"builtin", "prism"}}}, Json{{"transport", {{"mode", "thesis"}}}}}) {
        const Json refused = pupil.update(patch);
        EXPECT_EQ(refused["code"], "forbidden");
        EXPECT_EQ(refused["field"], patch.items().begin().key());
        EXPECT_EQ(refused["fatal"], false);
    }

    const std::string before = (pupil.requestFrame(), pupil.lastReply["map_hash"]);
    teacher.update(lightAt(0.75));
    const auto state = pupil.textOf("state");
    ASSERT_TRUE(state) << "its sliders move";
    EXPECT_EQ((*state)["state"]["lights"]["key"]["position"][0], 0.75);
    EXPECT_EQ((*state)["state"]["camera"]["eye"][0], 2.0);
    pupil.requestFrame(true);
    const std::string seen = pupil.lastReply["map_hash"];
    teacher.requestFrame(true);
    EXPECT_EQ(teacher.lastReply["map_hash"], seen) << "one map for both";
}

TEST_F(Sessions, AViewIdOpensNothingElse) {
    RawClient teacher(server_.port());
    const Json welcome = teacher.hello();
    RawClient stranger(server_.port());
    const Json other = stranger.hello({{"resume", {{"session", welcome["view_id"]}}}});
    EXPECT_EQ(other["resumed"], false);
    EXPECT_EQ(teacher.update(kSmall)["op"], "ok");
    RawClient nobody(server_.port());
    nobody.json({{"op", "hello"}, {"id", 1}, {"client", {{"name", "t"}, {"version", "1"}}}, {"role", "view"}, {"follow", "ffff"}});
    const auto error = nobody.textOf("error");
    ASSERT_TRUE(error);
    EXPECT_EQ((*error)["field"], "follow");
}

TEST_F(Sessions, WhatIsFollowedMayGoAndComeBack) {
    auto teacher = std::make_unique<RawClient>(server_.port());
    const Json welcome = teacher->hello();
    teacher->update(kSmall);
    teacher->update(lightAt(0.25));
    RawClient pupil(server_.port());
    pupil.hello({{"role", "view"}, {"follow", welcome["view_id"]}});
    RawClient pupilsPupil(server_.port());
    pupilsPupil.hello({{"role", "view"}, {"follow", welcome["view_id"]}});
    teacher.reset();
    auto status = pupil.textOf("status");
    ASSERT_TRUE(status);
    EXPECT_EQ((*status)["key"], "follow");
    EXPECT_EQ((*status)["level"], "warning");
    EXPECT_GT(pupil.requestFrame(true).payload.size(), 100u) << "what it showed last";

    RawClient back(server_.port());
    back.hello({{"resume", {{"session", welcome["session"]}}}});
    status = pupil.textOf("status");
    ASSERT_TRUE(status);
    EXPECT_EQ((*status)["message"], "");
    back.update({{"scene", {"builtin", "prism"}}, {"lights", nullptr}});
    const auto state = pupil.textOf("state");
    ASSERT_TRUE(state);
}

TEST(SessionLimits, AViewerGetsNoMoreMemoryThanItsShare) {
    ServerProcess server({"--viewer-mb", "16"});
    RawClient viewer(server.port());
    viewer.hello({{"resume", {{"session", "x"}, {"state", kSmall}}}});
    const Json refused = viewer.update({{"stream", {{"width", 2048}, {"height", 2048}}}});
    EXPECT_EQ(refused["code"], "busy");
    EXPECT_THAT(refused["message"].get<std::string>(), testing::HasSubstr("16"));
    EXPECT_EQ(viewer.update({{"stream", {{"width", 64}}}})["op"], "ok") << "nothing else was changed";
}

TEST(SessionLimits, AFastStreamsAcknowledgementsAreNoFlood) {
    ServerProcess server({"--test-frame-bytes", "100"});
    RawClient viewer(server.port());
    viewer.hello({{"max_inflight", 4}});
    viewer.update({{"stream", {{"width", 96}, {"height", 64}, {"max_fps", 240}}}});
    viewer.ask({{"op", "stream.start"}});
    for (int i = 0; i < 800; ++i) {  // more than 300 messages a second, but for those that only answer
        viewer.json({{"op", "input"}, {"seq", i + 1}, {"t_us", i}, {"camera", {{"eye", {0.001 * i, 1.0, 3.0}}}}});
        const auto picture = viewer.frame();
        ASSERT_TRUE(picture) << i;
        viewer.ack(picture->header.frameSeq);
    }
}

TEST(SessionLimits, TheLadderFollowsAViewerThatIsSlowAndOneThatIsNot) {
    ServerProcess server({"--test-frame-bytes", "20000"});
    RawClient viewer(server.port());
    viewer.hello({{"max_inflight", 4}});
    viewer.update({{"stream", {{"width", 96}, {"height", 64}, {"max_fps", 240}}}});
    viewer.ask({{"op", "stream.start"}});
    int level = 0;
    double x = 0.0;
    const auto play = [&](int frames, int delayMs, const auto& until) {
        for (int i = 0; i < frames && !until(); ++i) {
            viewer.json({{"op", "input"}, {"seq", i + 1}, {"t_us", i}, {"camera", {{"eye", {x += 0.001, 1.0, 3.0}}}}});
            const auto picture = viewer.frame();
            ASSERT_TRUE(picture);
            EXPECT_TRUE(picture->header.flags & protocol::kFrameTest);
            EXPECT_EQ(picture->header.viewWidth, 96);
            if (!(picture->header.flags & protocol::kFrameStill)) {
                level = picture->header.level;
                EXPECT_EQ((picture->header.flags & protocol::kFrameScaled) != 0, level >= 4);
            }
            usleep(static_cast<useconds_t>(1000 * delayMs));
            viewer.ack(picture->header.frameSeq);
        }
    };
    play(5, 0, [] { return false; });
    EXPECT_EQ(level, 0);
    play(100, 150, [&] { return level == 5; });
    EXPECT_EQ(level, 5) << "every frame waits for the one before it to be shown";
    play(1500, 8, [&] { return level == 0; });
    EXPECT_EQ(level, 0);
}

}  // namespace
}  // namespace caustream::e2e
