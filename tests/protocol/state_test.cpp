// The state document: defaults, round trips, and how its fields hang together.
#include <gtest/gtest.h>

#include "protocol/patch.h"
#include "samples.h"

namespace caustream::protocol {
namespace {

DecodeError errorOf(const char* document, bool strict = false) {
    const auto state = decodeState(Json::parse(document), {}, strict);
    EXPECT_FALSE(state.has_value()) << document;
    return state ? DecodeError{} : state.error();
}

TEST(State, AnEmptyDocumentIsEveryDefault) {
    const auto state = decodeState(Json::object());
    ASSERT_TRUE(state.has_value());
    EXPECT_EQ(*state, State{});
    EXPECT_EQ(
        toJson(State{}).dump(),
        R"({"camera":{"exposure":["auto"]},"environment":{},"lights":{},"materials":{},"scene":["builtin","gem"],)"
        R"("stream":{"bands":"rgb","encoding":"jpeg","height":512,"max_fps":60.0,"quality":["auto"],"sample":"u8",)"
        R"("target":"composite","width":512},"transport":{"back_steps":4,"bounces":8,"budget_ms":0.0,"exact_receivers":false,)"
        R"("filter":true,"force_dispersive":false,"gap_fill":false,"hierarchy_levels":3,"map_size":512,"mode":"auto","photon_grid":0,)"
        R"("receiver_steps":6,"target_error":0.0,"wavelengths":"continuous"}})");
}

TEST(State, EveryFieldComesBack) {
    const auto state = decodeState(toJson(fullState()), {}, true);
    ASSERT_TRUE(state.has_value()) << state.error().field << " " << state.error().message;
    EXPECT_EQ(*state, fullState());
}

TEST(State, EveryTargetAndSampleComesBack) {
    for (const char* stream : {R"({"target":"spectral","encoding":"raw","sample":"f16"})",
                               R"({"target":"spectral","encoding":"raw","sample":"f32","bands":"wavelengths"})",
                               R"({"target":"composite","encoding":"png","sample":"u8"})",
                               R"({"target":"gap_fill","encoding":"raw","sample":"f32","quality":["fixed",1]})"}) {
        const auto state = decodeState(Json{{"stream", Json::parse(stream)}});
        ASSERT_TRUE(state.has_value()) << stream << state.error().message;
        EXPECT_EQ(decodeState(toJson(*state)), state);
    }
}

// A file may write pi/2 as 1.5708 and has its own idea of bright: its document is still one that clients can read.
TEST(State, WhatASceneFileMayHoldIsReadable) {
    State state;
    state.lights["lamp"] = {
        LightType::Spot, Vec3{1e8, 0, 0}, Vec3{0, -1, 0}, 90.0002104, 0.0, Intensity{Intensity::Unit::Candela, 1e12},
        Vec3{4, 4, 4}};
    state.materials["gem"] = {ConstantIndex{9.5}, Absorption{{380, 680}, {1e8, 1e9}}};
    state.materials["faint"] = {Abbe{1.5, 2e10}, Absorption{}};
    EXPECT_EQ(decodeState(toJson(state)), state);
}

TEST(State, NamesMayHoldAnything) {
    State state;
    state.lights["a/b.c~d \xc3\xa9"].color = Vec3{1, 1, 1};
    EXPECT_EQ(decodeState(toJson(state)), state);
    EXPECT_EQ(errorOf(R"({"lights":{"":{}}})").field, "lights");
    EXPECT_FALSE(decodeState(Json{{"materials", {{std::string(129, 'x'), Json::object()}}}}).has_value());
}

TEST(State, StreamFieldsThatDoNotGoTogetherAreNamed) {
    EXPECT_EQ(errorOf(R"({"stream":{"target":"spectral"}})").field, "stream.encoding");
    EXPECT_EQ(errorOf(R"({"stream":{"target":"spectral","encoding":"raw"}})").field, "stream.sample");
    EXPECT_EQ(errorOf(R"({"stream":{"sample":"f32"}})").field, "stream.sample");
    EXPECT_EQ(errorOf(R"({"stream":{"encoding":"png","sample":"f16"}})").code, ErrorCode::BadRequest);
}

TEST(State, PicturesAndMapsFitTheLimits) {
    EXPECT_TRUE(decodeState(Json::parse(R"({"stream":{"width":4096,"height":2026}})")).has_value());
    EXPECT_EQ(errorOf(R"({"stream":{"width":4096,"height":2027}})").field, "stream");
    const char* map = R"({"stream":{"target":"spectral","encoding":"raw","sample":"f32","bands":"wavelengths"},
                          "transport":{"map_size":2048,"wavelengths":17}})";
    EXPECT_EQ(errorOf(map).field, "transport.map_size") << "2048^2 * 17 * 4 bytes are more than 256 MiB";
    Json fits = Json::parse(map);
    fits["transport"]["wavelengths"] = 16;
    EXPECT_TRUE(decodeState(fits).has_value());
}

TEST(State, UnknownFieldsMatterOnlyWhenStrict) {
    for (const char* path :
         {"x", "lights.key.x", "materials.glass.x", "camera.x", "environment.x", "transport.x", "stream.x"}) {
        const auto patch = setPath(Json::object(), path, 1);
        ASSERT_TRUE(patch.has_value());
        const auto kept = applyPatch(Json::object(), *patch);
        ASSERT_TRUE(kept.has_value()) << path;
        EXPECT_EQ(kept->document.dump().find("\"x\""), std::string::npos) << "what is not known is not kept";
        const auto strict = applyPatch(Json::object(), *patch, {}, true);
        ASSERT_FALSE(strict.has_value()) << path;
        EXPECT_EQ(strict.error().code, ErrorCode::UnknownField);
        EXPECT_EQ(strict.error().field, path);
    }
}

TEST(State, OnlyKnownChoicesAreTaken) {
    for (const auto& [document, field] : std::vector<std::pair<const char*, const char*>>{
             {R"({"scene":["file","/etc/passwd"]})", "scene[0]"},
             {R"({"transport":{"mode":"bidirectional"}})", "transport.mode"},
             {R"({"transport":{"wavelengths":"endless"}})", "transport.wavelengths"},
             {R"({"stream":{"encoding":"webp"}})", "stream.encoding"},
             {R"({"stream":{"sample":"u16"}})", "stream.sample"},
             {R"({"stream":{"bands":"cmyk"}})", "stream.bands"},
             {R"({"stream":{"quality":["best"]}})", "stream.quality[0]"},
             {R"({"camera":{"exposure":["iso",100]}})", "camera.exposure[0]"},
             {R"({"lights":{"key":{"type":"area"}}})", "lights.key.type"},
             {R"({"lights":{"key":{"intensity":["lm",5]}}})", "lights.key.intensity[0]"},
             {R"({"lights":{"key":{"spectrum":["A"]}}})", "lights.key.spectrum[0]"},
             {R"({"lights":{"key":{"cookie":["url",1]}}})", "lights.key.cookie[0]"},
             {R"({"materials":{"glass":{"dispersion":["schott",1,2]}}})", "materials.glass.dispersion[0]"}}) {
        EXPECT_EQ(errorOf(document).code, ErrorCode::Unsupported) << document;
        EXPECT_EQ(errorOf(document).field, field);
    }
}

TEST(State, TaggedArraysHaveTheirOwnLengths) {
    for (const char* document : {R"({"scene":[]})",
                                 R"({"scene":["builtin"]})",
                                 R"({"scene":["builtin","a","b"]})",
                                 R"({"scene":["builtin",""]})",
                                 R"({"scene":["asset","abc"]})",
                                 R"({"scene":"gem"})",
                                 R"({"lights":{"k":{"spectrum":["E",1]}}})",
                                 R"({"lights":{"k":{"spectrum":["blackbody"]}}})",
                                 R"({"lights":{"k":{"spectrum":["lines"]}}})",
                                 R"({"lights":{"k":{"spectrum":["lines",500,400]}}})",
                                 R"({"lights":{"k":{"spectrum":["lines",500,500]}}})",
                                 R"({"lights":{"k":{"cookie":["texture"]}}})",
                                 R"({"lights":{"k":{"cookie":["none",1]}}})",
                                 R"({"lights":{"k":{"intensity":["cd"]}}})",
                                 R"({"lights":{"k":{"position":[1,2]}}})",
                                 R"({"lights":{"k":{"position":[1,2,3,4]}}})",
                                 R"({"lights":{"k":5}})",
                                 R"({"lights":[]})",
                                 R"({"camera":[]})",
                                 R"({"camera":{"exposure":["auto",1]}})",
                                 R"({"camera":{"exposure":["ev"]}})",
                                 R"({"stream":{"quality":["fixed"]}})",
                                 R"({"materials":{"g":{"dispersion":["constant"]}}})",
                                 R"({"materials":{"g":{"dispersion":["cauchy",1.5]}}})",
                                 R"({"materials":{"g":{"dispersion":["abbe",1.5,60,1]}}})",
                                 R"({"materials":{"g":{"dispersion":["sellmeier",1,1,1,0,0]}}})",
                                 R"({"materials":{"g":{"absorption":[[400],[]]}}})",
                                 R"({"materials":{"g":{"absorption":[[500,400],[1,1]]}}})",
                                 R"({"transport":{"wavelengths":[]}})",
                                 R"({"transport":{"wavelengths":[500,450]}})",
                                 R"({"transport":{"gap_fill":1}})",
                                 R"({"transport":{"mode":"thesis","wavelengths":8}})",
                                 R"({"transport":{"mode":"thesis","wavelengths":[500]}})",
                                 R"({"transport":{"mode":"refined","budget_ms":16,"target_error":0.01}})",
                                 R"({"transport":{"mode":"thesis","budget_ms":16,"target_error":0.01}})",
                                 R"({"transport":{"exact_receivers":1}})",
                                 R"({"transport":{"bounces":"all"}})",
                                 R"({"environment":{"color":5}})"}) {
        const auto state = decodeState(Json::parse(document));
        EXPECT_FALSE(state.has_value()) << document;
    }
}

// So many photons a frame, and so many frames.
TEST(State, WhatConvergesHasABudgetAndATarget) {
    for (const char* mode : {"auto", "traced"}) {
        const auto state = decodeState(Json{{"transport", {{"mode", mode}, {"budget_ms", 16}, {"target_error", 0.02}}}});
        ASSERT_TRUE(state.has_value()) << mode;
        EXPECT_EQ(decodeState(toJson(*state)), state);
    }
}

TEST(State, WavelengthsMayBeContinuous) {
    for (const char* mode : {"auto", "traced", "refined", "thesis"}) {
        const auto state = decodeState(Json{{"transport", {{"mode", mode}, {"wavelengths", "continuous"}}}});
        ASSERT_TRUE(state.has_value()) << mode;
        EXPECT_EQ(state->transport.wavelengths, kContinuous);
        EXPECT_EQ(toJson(*state).at("transport").at("wavelengths"), "continuous");
    }
}

TEST(State, AnIndexOfRefractionStaysPhysicalOverTheBand) {
    const auto takes = [](const char* dispersion) {
        return decodeState(Json{{"materials", {{"glass", {{"dispersion", Json::parse(dispersion)}}}}}}).has_value();
    };
    EXPECT_TRUE(takes(R"(["cauchy",1.7280,0.01342])"));                                // SF10
    EXPECT_TRUE(takes(R"(["sellmeier",1.0396,0.2318,1.0105,0.0060,0.0200,103.56])"));  // BK7
    EXPECT_TRUE(takes(R"(["abbe",1.0,20])"));
    EXPECT_TRUE(takes(R"(["cauchy",1.5,0.6])")) << "5.66 in the violet";
    EXPECT_FALSE(takes(R"(["cauchy",1.0,-0.2])")) << "below 1";
    EXPECT_FALSE(takes(R"(["cauchy",1.5,2])")) << "15 in the violet";
    EXPECT_FALSE(takes(R"(["sellmeier",1,0,0,0.25,0,0])")) << "resonance at 500 nm";
    EXPECT_FALSE(takes(R"(["sellmeier",1e-9,0,0,0.25050025,0,0])")) << "a resonance too thin for samples to see";
    EXPECT_FALSE(takes(R"(["sellmeier",-2,0,0,0,0,0])")) << "imaginary";
    EXPECT_FALSE(takes(R"(["constant",0.9])"));
}

}  // namespace
}  // namespace caustream::protocol
