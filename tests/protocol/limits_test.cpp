// Every number of the state document at, just inside and just outside its range.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "protocol/patch.h"

namespace caustream::protocol {
namespace {

struct Range {
    const char* path;    // of the value, or of the array around it
    const char* around;  // the value's JSON, $ where the number goes
    double min, max;
    double step;        // to just outside
    const char* field;  // as an error names it
};

const Range kRanges[] = {
    {"lights.key.position", "[0,$,0]", -1e9, 1e9, 1, "lights.key.position[1]"},
    {"lights.key.direction", "[1,$,0]", -1e6, 1e6, 1, "lights.key.direction[1]"},
    {"lights.key.half_angle_deg", "$", 1e-6, 90.001, 5e-7, "lights.key.half_angle_deg"},
    {"lights.key.inner_angle_deg", "$", 0, 90.001, 1e-6, "lights.key.inner_angle_deg"},
    {"lights.key.intensity", "[\"cd\",$]", 0, 1e12, 1, "lights.key.intensity[1]"},
    {"lights.key.color", "[0,0,$]", 0, 1e6, 0.001, "lights.key.color[2]"},
    {"lights.key.spectrum", "[\"blackbody\",$]", 1000, 40000, 1, "lights.key.spectrum[1]"},
    {"lights.key.spectrum", "[\"lines\",$]", 380, 680, 0.01, "lights.key.spectrum[1]"},
    {"lights.key.cookie", "[\"texture\",$]", 0, 4095, 1, "lights.key.cookie[1]"},
    {"materials.glass.dispersion", "[\"constant\",$]", 1, 10, 1e-9, "materials.glass.dispersion[1]"},
    {"materials.glass.dispersion", "[\"abbe\",1,$]", 1e-3, 1e12, 1e-3, "materials.glass.dispersion[2]"},
    {"materials.glass.absorption", "[[500],[$]]", 0, 1e12, 1, "materials.glass.absorption[1][0]"},
    {"materials.glass.absorption", "[[$],[1]]", 0, 1e6, 1, "materials.glass.absorption[0][0]"},
    {"camera.eye", "[$,0,0]", -1e9, 1e9, 1, "camera.eye[0]"},
    {"camera.target", "[$,0,0]", -1e9, 1e9, 1, "camera.target[0]"},
    {"camera.up", "[$,1,0]", -1e6, 1e6, 1, "camera.up[0]"},
    {"camera.fov_y_deg", "$", 1, 170, 1e-9, "camera.fov_y_deg"},
    {"camera.exposure", "[\"ev\",$]", -32, 32, 0.001, "camera.exposure[1]"},
    {"environment.color", "[$,0,0]", 0, 1e6, 0.001, "environment.color[0]"},
    {"outside_index", "$", 1, 5, 1e-9, "outside_index"},
    {"transport.wavelengths", "$", 1, 64, 1, "transport.wavelengths"},
    {"transport.wavelengths", "[$]", 380, 680, 0.01, "transport.wavelengths[0]"},
    {"transport.photon_grid", "$", 16, 2048, 1, "transport.photon_grid"},
    {"transport.map_size", "$", 64, 2048, 16, "transport.map_size"},
    {"transport.back_steps", "$", 1, 16, 1, "transport.back_steps"},
    {"transport.receiver_steps", "$", 1, 32, 1, "transport.receiver_steps"},
    {"transport.hierarchy_levels", "$", 1, 6, 1, "transport.hierarchy_levels"},
    {"transport.bounces", "$", 0, 32, 1, "transport.bounces"},
    {"transport.budget_ms", "$", 0, 60000, 0.001, "transport.budget_ms"},
    {"transport.target_error", "$", 0, 1, 1e-6, "transport.target_error"},
    {"stream.width", "$", 16, 4096, 1, "stream.width"},
    {"stream.height", "$", 16, 4096, 1, "stream.height"},
    {"stream.quality", "[\"fixed\",$]", 1, 100, 1, "stream.quality[1]"},
    {"stream.max_fps", "$", 1, 240, 0.001, "stream.max_fps"},
};

Json valueWith(const Range& range, const Json& number) {
    std::string text = range.around;
    return Json::parse(text.replace(text.find('$'), 1, number.dump()));
}

Json asWritten(double number) {
    return number == std::floor(number) ? Json(std::int64_t(number)) : Json(number);
}

tl::expected<Applied, DecodeError> applied(const Range& range, const Json& number) {
    return applyPatch(Json::object(), *setPath(Json::object(), range.path, valueWith(range, number)));
}

TEST(Limits, BothEndsOfEveryRangeAreIn) {
    for (const Range& range : kRanges)
        for (const double number : {range.min, range.max}) {
            const auto result = applied(range, asWritten(number));
            EXPECT_TRUE(result.has_value()) << range.path << " " << number << ": " << result.error().message;
        }
}

TEST(Limits, BeyondEitherEndOfEveryRangeIsOut) {
    for (const Range& range : kRanges)
        for (const double number : {range.min - range.step, range.max + range.step, -1e300, 1e300}) {
            const auto result = applied(range, asWritten(number));
            ASSERT_FALSE(result.has_value()) << range.path << " " << number;
            EXPECT_EQ(result.error().code, ErrorCode::OutOfRange) << range.path << " " << number;
            EXPECT_EQ(result.error().field, range.field);
        }
}

TEST(Limits, WrongTypesAreNamed) {
    for (const Range& range : kRanges)
        for (const Json& wrong : {Json("5"), Json(true), Json::object(), Json::array({Json::array()})}) {
            const auto result = applied(range, wrong);
            ASSERT_FALSE(result.has_value()) << range.path << " " << wrong;
            EXPECT_NE(result.error().code, ErrorCode::OutOfRange) << range.path << " " << wrong;
            EXPECT_TRUE(result.error().field.starts_with(range.path)) << result.error().field;
        }
}

// Documents built in memory may hold what text cannot.
TEST(Limits, NumbersThatAreNoneAreOut) {
    for (const Range& range : kRanges) {
        if (std::string(range.around) != "$") continue;
        for (const double none : {std::nan(""), std::numeric_limits<double>::infinity()}) {
            const auto result = applyPatch(Json::object(), *setPath(Json::object(), range.path, none));
            ASSERT_FALSE(result.has_value()) << range.path;
            EXPECT_EQ(result.error().code, ErrorCode::OutOfRange);
        }
    }
}

TEST(Limits, IntegersAreNotTruncated) {
    for (const char* path : {"transport.wavelengths", "transport.photon_grid", "transport.map_size",
                             "transport.bounces", "transport.back_steps", "transport.receiver_steps", "stream.width", "stream.height"}) {
        const auto result = applyPatch(Json::object(), *setPath(Json::object(), path, 64.5));
        ASSERT_FALSE(result.has_value()) << path;
        EXPECT_EQ(result.error().code, ErrorCode::BadRequest);
    }
    EXPECT_EQ(applyPatch(Json::object(), *setPath(Json::object(), "stream.width", 512.0))->state.stream.width, 512);
}

TEST(Limits, SpecialValues) {
    const auto codeOf = [](const char* path, const char* value) {
        const auto result = applyPatch(Json::object(), *setPath(Json::object(), path, Json::parse(value)));
        return result ? std::string_view("accepted") : errorName(result.error().code);
    };
    EXPECT_EQ(codeOf("transport.photon_grid", "0"), "accepted");
    EXPECT_EQ(codeOf("transport.photon_grid", "1"), "out_of_range");
    EXPECT_EQ(codeOf("transport.map_size", "72"), "out_of_range") << "no multiple of 16";
    EXPECT_EQ(codeOf("lights.key.direction", "[0,0,0]"), "out_of_range");
    EXPECT_EQ(codeOf("camera.up", "[0,1e-9,0]"), "out_of_range");
    EXPECT_EQ(codeOf("camera", R"({"eye":[1,2,3],"target":[1,2,3]})"), "out_of_range");
    EXPECT_EQ(codeOf("lights.key", R"({"half_angle_deg":20,"inner_angle_deg":20})"), "accepted");
    EXPECT_EQ(codeOf("lights.key", R"({"half_angle_deg":20,"inner_angle_deg":21})"), "out_of_range");
    EXPECT_EQ(codeOf("materials.glass.absorption", "[[],[]]"), "accepted");
}

TEST(Limits, WavelengthsAreCounted) {
    Json many = Json::array();
    for (int i = 0; i < 64; ++i) many.push_back(400 + i);
    EXPECT_TRUE(decodeState(Json{{"transport", {{"wavelengths", many}}}}).has_value());
    many.push_back(500);
    EXPECT_FALSE(decodeState(Json{{"transport", {{"wavelengths", many}}}}).has_value());
}

}  // namespace
}  // namespace caustream::protocol
