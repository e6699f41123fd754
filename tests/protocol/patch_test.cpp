// Patches: merged as RFC 7396 says, whole or not at all, and addressed by paths.
#include "protocol/patch.h"

#include <gtest/gtest.h>

#include "samples.h"

namespace caustream::protocol {
namespace {

Json parse(const char* text) {
    return Json::parse(text);
}

TEST(Patch, ChangesWhatItNamesAndNothingElse) {
    const Json before = toJson(fullState());
    const auto after = applyPatch(before, parse(R"({"camera":{"fov_y_deg":50}})"));
    ASSERT_TRUE(after.has_value());
    State expected = fullState();
    expected.camera.fovYDeg = 50;
    EXPECT_EQ(after->state, expected);
    EXPECT_EQ(after->document, toJson(expected));
}

TEST(Patch, AnEmptyOneChangesNothing) {
    const Json before = toJson(fullState());
    EXPECT_EQ(applyPatch(before, Json::object())->document, before);
}

TEST(Patch, ReplacesATaggedArrayWhole) {
    const auto first =
        applyPatch(Json::object(), parse(R"({"materials":{"g":{"dispersion":["cauchy",1.5,0.004,0.0001]}}})"));
    ASSERT_TRUE(first.has_value());
    const auto second = applyPatch(first->document, parse(R"({"materials":{"g":{"dispersion":["constant",1.4]}}})"));
    ASSERT_TRUE(second.has_value());
    EXPECT_EQ(second->document["materials"]["g"]["dispersion"], parse(R"(["constant",1.4])"));
}

TEST(Patch, NullBringsTheDefaultBack) {
    const Json full = toJson(fullState());
    const auto cleared = applyPatch(
        full, parse(R"({"lights":{"lamp.001":{"position":null},"sun":null},"camera":null,"outside_index":null,
                        "environment":null,"materials":null,"transport":{"wavelengths":null},"stream":null,"scene":null})"));
    ASSERT_TRUE(cleared.has_value()) << cleared.error().message;
    State expected = fullState();
    expected.scene = {};
    expected.lights["lamp.001"].position.reset();
    expected.lights.erase("sun");
    expected.camera = {};
    expected.outsideIndex.reset();
    expected.environmentColor.reset();
    expected.materials.clear();
    expected.transport.wavelengthsNm.clear();
    expected.stream = {};
    EXPECT_EQ(cleared->state, expected);
}

TEST(Patch, ABadFieldLeavesTheDocumentAsItWas) {
    const Json before = toJson(fullState());
    const Json copy = before;
    const auto result = applyPatch(before, parse(R"({"camera":{"fov_y_deg":50,"eye":[1,2,"x"]},"outside_index":1.2})"));
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().field, "camera.eye[2]");
    EXPECT_EQ(before, copy);
}

TEST(Patch, MustBeAnObjectNotTooDeepAndNotTooLong) {
    for (const char* wrong : {"null", "5", "[]", "\"x\""})
        EXPECT_EQ(applyPatch(Json::object(), parse(wrong)).error().code, ErrorCode::BadRequest);
    Json deep = 1;
    for (int i = 0; i < 33; ++i) deep = Json{{"a", std::move(deep)}};
    EXPECT_EQ(applyPatch(Json::object(), deep).error().code, ErrorCode::BadRequest);
    Json many = Json::object();
    for (int i = 0; i < 4096; ++i) many[std::to_string(i)] = Json::object();
    EXPECT_EQ(applyPatch(Json::object(), Json{{"lights", many}}).error().code, ErrorCode::TooLarge);
    many["one more"] = Json::object();
    EXPECT_EQ(applyPatch(Json::object(), Json{{"lights", many}}).error().field, "lights");
}

TEST(Patch, AnotherSceneComesWithoutTheOldOverrides) {
    const auto result = applyPatch(toJson(fullState()), sceneChange({SceneRef::Kind::Builtin, "prism"}));
    ASSERT_TRUE(result.has_value());
    State expected;
    expected.scene.name = "prism";
    expected.transport = fullState().transport;
    expected.stream = fullState().stream;
    EXPECT_EQ(result->state, expected);
}

TEST(SetPath, TakesDotsAndJsonPointers) {
    const Json document = toJson(fullState());
    const Json value = parse("[1,2,3]");
    EXPECT_EQ(*setPath(document, "lights.key.position", value), parse(R"({"lights":{"key":{"position":[1,2,3]}}})"));
    EXPECT_EQ(*setPath(document, "/lights/key/position", value), parse(R"({"lights":{"key":{"position":[1,2,3]}}})"));
    EXPECT_EQ(*setPath(document, "/lights/lamp.001/position", value),
              parse(R"({"lights":{"lamp.001":{"position":[1,2,3]}}})"));
    EXPECT_EQ(*setPath(document, "/lights/a~1b~0c/color", value), parse(R"({"lights":{"a/b~c":{"color":[1,2,3]}}})"));
    EXPECT_EQ(*setPath(document, "scene", parse(R"(["builtin","gem"])")), parse(R"({"scene":["builtin","gem"]})"));
    EXPECT_EQ(*setPath(document, "camera.fov_y_deg", nullptr), parse(R"({"camera":{"fov_y_deg":null}})"));
}

TEST(SetPath, ReplacesOneElementOfAnArrayThatIsThere) {
    const Json document = toJson(fullState());
    EXPECT_EQ(*setPath(document, "camera.eye.1", 5), parse(R"({"camera":{"eye":[0.0,5,3.0]}})"));
    EXPECT_EQ(*setPath(document, "/materials/BK7/absorption/1/0", 9),
              parse(R"({"materials":{"BK7":{"absorption":[[400.0,700.0],[9,0.25]]}}})"));
    EXPECT_EQ(setPath(document, "camera.eye.3", 5).error().code, ErrorCode::OutOfRange);
    EXPECT_EQ(setPath(document, "camera.eye.99999999999999999999", 5).error().code, ErrorCode::BadRequest);
    for (const char* wrong : {"camera.eye.x", "camera.eye.-1", "camera.eye.1x", "camera.eye.1.0"})
        EXPECT_EQ(setPath(document, wrong, 5).error().code, ErrorCode::BadRequest) << wrong;
}

TEST(SetPath, WrongPathsAreErrors) {
    for (const char* wrong : {"", ".", "/", "a..b", ".a", "a.", "/a//b", "/a/", "/a~", "/a~2"}) {
        const auto patch = setPath(Json::object(), wrong, 1);
        ASSERT_FALSE(patch.has_value()) << wrong;
        EXPECT_EQ(patch.error().field, wrong);
    }
    EXPECT_FALSE(setPath(Json::object(), "a" + std::string(1000, '.'), 1).has_value());
    std::string deep = "a";
    for (int i = 0; i < 40; ++i) deep += ".a";
    EXPECT_FALSE(setPath(Json::object(), deep, 1).has_value());
}

TEST(SetPath, ReachesEveryLeafOfADocument) {
    const Json document = toJson(fullState());
    const Json flat = document.flatten();
    for (const auto& [pointer, value] : flat.items()) {
        const auto patch = setPath(document, pointer, value);
        ASSERT_TRUE(patch.has_value()) << pointer;
        const auto result = applyPatch(document, *patch);
        ASSERT_TRUE(result.has_value()) << pointer << ": " << result.error().field << " " << result.error().message;
        EXPECT_EQ(result->document, document) << pointer;
    }
}

TEST(Settings, AreJsonOrWords) {
    EXPECT_EQ(parseSetting("camera.eye=[1,2,3]")->value, parse("[1,2,3]"));
    EXPECT_EQ(parseSetting("transport.mode=thesis")->value, Json("thesis"));
    EXPECT_EQ(parseSetting("/lights/a=b")->path, "/lights/a");
    EXPECT_FALSE(parseSetting("camera.eye"));
    EXPECT_FALSE(parseSetting("=3"));
    EXPECT_FALSE(parseSetting("camera.eye=[1,2"));
}

TEST(Settings, MakeOnePatch) {
    const Json document = parse(R"({"camera":{"eye":[1,2,3],"fov_y_deg":40}})");
    const auto patch = settingsPatch(document, {{"camera.eye.0", 5}, {"camera.eye.2", 6}, {"camera.fov_y_deg", nullptr}});
    ASSERT_TRUE(patch);
    EXPECT_EQ(*patch, parse(R"({"camera":{"eye":[5,2,6],"fov_y_deg":null}})"));
    EXPECT_EQ(settingsPatch(document, {{"camera.eye.7", 1}}).error().field, "camera.eye.7");
}

}  // namespace
}  // namespace caustream::protocol
