// What caustream-shot makes of a batch's lines and of a log, before it asks any server.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "client/shot/batch_plan.h"
#include "client/shot/camera_matrix.h"
#include "client/shot/exr_file.h"
#include "client/shot/log_file.h"

namespace caustream::shot {
namespace {

using protocol::Json;
using testing::ElementsAre;
using testing::HasSubstr;

std::string temporary(const std::string& name) { return testing::TempDir() + std::to_string(getpid()) + "-" + name; }

// The field that is wrong, and part of what is said of it.
void expectWrong(const std::string& text, const std::string& field, const std::string& part) {
    const auto line = parseBatchLine(text, 1);
    ASSERT_FALSE(line) << text;
    EXPECT_EQ(line.error().field, field) << text;
    EXPECT_THAT(line.error().message, HasSubstr(part)) << text;
}

TEST(BatchLine, HasANameOfItsNumberAndNothingElseByDefault) {
    const auto line = parseBatchLine("{}", 12);
    ASSERT_TRUE(line);
    EXPECT_EQ(*line, (BatchLine{.name = "000012", .patch = Json::object()}));
}

TEST(BatchLine, TakesAllThatItKnows) {
    const auto line = parseBatchLine(R"({"name": "a-1_b.c", "patch": {"camera": {"eye": [0, 1, 2]}, "lights": null},
                                         "targets": ["composite", "depth"], "converge": false})", 1);
    ASSERT_TRUE(line) << line.error().text();
    EXPECT_EQ(line->name, "a-1_b.c");
    EXPECT_EQ(line->patch["camera"]["eye"], (Json{0, 1, 2}));
    EXPECT_TRUE(line->patch["lights"].is_null()) << "null takes away, it is not nothing";
    EXPECT_THAT(line->targets, ElementsAre("composite", "depth"));
    EXPECT_EQ(line->converge, false);
}

TEST(BatchLine, SaysWhichFieldIsWrong) {
    expectWrong("", "", "");
    expectWrong("[]", "", "must be a JSON object");
    expectWrong("{\"name\": \"a\", \"name\": \"b\"}", "", "name");
    expectWrong(R"({"camera": {}})", "camera", "is not known");
    expectWrong(R"({"patch": []})", "patch", "must be an object");
    expectWrong(R"({"targets": []})", "targets", "must be a list");
    expectWrong(R"({"targets": "depth"})", "targets", "must be a list");
    expectWrong(R"({"targets": ["depth", 3]})", "targets[1]", "must be a text");
    expectWrong(R"({"targets": ["depth", "normals", "depth"]})", "targets[2]", "twice");
    expectWrong(R"({"converge": 1})", "converge", "true or false");
    expectWrong(R"({"patch": {"stream": {"target": "depth"}}})", "patch.stream.target", "targets");
    for (const char* name : {"", ".", "..", ".hidden", "a/b", "a b", "\\u00e4", "a\\u0000"}) expectWrong(std::string(R"({"name": ")") + name + "\"}", "name", "name a file");
    expectWrong(R"({"name": ")" + std::string(101, 'a') + "\"}", "name", "name a file");
    expectWrong(R"({"patch": {"a": ")" + std::string(70000, 'a') + "\"}}", "", "");
}

TEST(BatchLine, AnotherSceneBeginsAsItsFileHasIt) {
    const Json start = {{"scene", {"builtin", "gem"}}, {"lights", {{"key", {{"position", {0, 2, 0}}}}}}, {"camera", {{"fov_y_deg", 30}}}, {"transport", {{"map_size", 256}}}};
    const Json same = lineDocument(start, {{"scene", {"builtin", "gem"}}, {"camera", {{"eye", {1, 1, 1}}}}});
    EXPECT_EQ(same["camera"], (Json{{"fov_y_deg", 30}, {"eye", {1, 1, 1}}}));
    EXPECT_TRUE(same.contains("lights"));
    const Json other = lineDocument(start, {{"scene", {"builtin", "prism"}}, {"camera", {{"eye", {1, 1, 1}}}}});
    EXPECT_EQ(other["camera"], (Json{{"eye", {1, 1, 1}}}));
    EXPECT_FALSE(other.contains("lights"));
    EXPECT_EQ(other["transport"]["map_size"], 256);
}

TEST(BatchLine, ThePatchBetweenTwoDocumentsMakesOneOfTheOther) {
    const Json a = {{"x", 1}, {"deep", {{"kept", {1, 2}}, {"gone", true}, {"changed", {1}}}}, {"gone", {{"y", 1}}}, {"kind", {{"a", 1}}}};
    const Json b = {{"x", 2}, {"deep", {{"kept", {1, 2}}, {"changed", {1, 2}}, {"new", "n"}}}, {"kind", 7}, {"more", {{"z", 1}}}};
    for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}, std::pair{a, a}, std::pair{Json::object(), a}, std::pair{a, Json::object()}}) {
        Json document = from;
        document.merge_patch(patchBetween(from, to));
        EXPECT_EQ(document, to);
    }
    EXPECT_EQ(patchBetween(a, a), Json::object());
    EXPECT_FALSE(patchBetween(a, b)["deep"].contains("kept")) << "as small as it can be";
}

class BatchPlanTest : public testing::Test {
 protected:
    static PlanOptions options() {
        return {.start = {{"scene", {"builtin", "gem"}}, {"stream", {{"width", 64}, {"height", 64}}}},
                .targets = {"composite"},
                .formats = {Format::Png, Format::Exr},
                .passes = {"shadow", "depth", "normals", "caster_mask"},
                .folder = testing::TempDir()};
    }
    static BatchPlan plan(const std::string& lines, const PlanOptions& options = BatchPlanTest::options()) {
        std::istringstream in(lines);
        return planBatch(in, options);
    }
};

TEST_F(BatchPlanTest, BadLinesDoNotKeepGoodOnesFromBeingDrawn) {
    const BatchPlan made = plan("{\"name\": \"a\"}\n\n{\"nam\": 1}\n{\"name\": \"a\"}\n{\"patch\": {\"camera\": {\"fov_y_deg\": 200}}}\n"
                                "{\"targets\": [\"composite\", \"dept\"]}\n{\"patch\": {\"camera\": {\"fov\": 20}}}\n{\"targets\": [\"depth\", \"shadow\"]}");
    ASSERT_EQ(made.jobs.size(), 2u);
    EXPECT_EQ(made.jobs[1].number, 8) << "lines count from 1, empty ones too";
    std::vector<std::string> said;
    for (const BadLine& bad : made.bad) said.push_back(std::to_string(bad.number) + " " + bad.error.field);
    EXPECT_THAT(said, ElementsAre("3 nam", "4 name", "5 patch.camera.fov_y_deg", "6 targets[1]", "7 patch.camera.fov"));
    EXPECT_THAT(made.bad[3].error.message, HasSubstr("caster_mask")) << "it says what there is";
}

TEST_F(BatchPlanTest, ATargetThatNoFormatHoldsIsWrong) {
    PlanOptions png = options(), exr = options();
    png.formats = {Format::Png}, exr.formats = {Format::Exr};
    EXPECT_THAT(plan(R"({"targets": ["depth"]})", png).bad.at(0).error.message, HasSubstr("npy or exr"));
    EXPECT_THAT(plan(R"({"targets": ["shadow"]})", exr).bad.at(0).error.message, HasSubstr("png"));
    EXPECT_TRUE(plan(R"({"targets": ["caster_mask", "normals", "composite"]})", png).bad.empty());
}

TEST_F(BatchPlanTest, TheKeyIsOfWhatTheFilesDependOnAndOfNothingElse) {
    const std::string line = R"({"name": "a", "patch": {"camera": {"fov_y_deg": 30}}})";
    const std::string key = plan(line).jobs.at(0).key;
    EXPECT_EQ(key.size(), 64u);
    EXPECT_EQ(plan("\n" + line).jobs.at(0).key, key) << "whichever line it is";
    EXPECT_EQ(plan(R"({"name": "b", "patch": {"camera": {"fov_y_deg": 30}, "lights": null}})").jobs.at(0).key, key);
    EXPECT_NE(plan(R"({"name": "a", "patch": {"camera": {"fov_y_deg": 31}}})").jobs.at(0).key, key);
    EXPECT_NE(plan(R"({"name": "a", "patch": {"camera": {"fov_y_deg": 30}}, "converge": true})").jobs.at(0).key, key);
    EXPECT_NE(plan(R"({"name": "a", "patch": {"camera": {"fov_y_deg": 30}}, "targets": ["depth"]})").jobs.at(0).key, key);
    PlanOptions other = options();
    other.formats = {Format::Png};
    EXPECT_NE(plan(line, other).jobs.at(0).key, key);
    other = options();
    other.start["stream"]["width"] = 65;
    EXPECT_NE(plan(line, other).jobs.at(0).key, key);
}

TEST_F(BatchPlanTest, AFilesSceneIsItsContent) {
    const std::string path = temporary("caustream-batch.glb"), line = "{\"patch\": {\"scene\": [\"file\", \"" + std::filesystem::path(path).filename().string() + "\"]}}";
    std::ofstream(path) << "one";
    const BatchPlan first = plan(line);
    ASSERT_EQ(first.jobs.size(), 1u) << first.bad.at(0).error.text();
    EXPECT_EQ(first.jobs[0].document["scene"], (Json{"file", path}));
    std::ofstream(path) << "two";
    EXPECT_NE(plan(line).jobs.at(0).key, first.jobs[0].key);
    std::filesystem::remove(path);
    EXPECT_EQ(plan(line).bad.at(0).error.field, "patch.scene[1]");
}

TEST(Exr, ChannelsAreCalledAsOthersExpect) {
    EXPECT_THAT(exrChannels("linear", 3, {}), ElementsAre("R", "G", "B"));
    EXPECT_THAT(exrChannels("m", 1, {}), ElementsAre("Z"));
    EXPECT_THAT(exrChannels("normal", 3, {}), ElementsAre("N.X", "N.Y", "N.Z"));
    EXPECT_THAT(exrChannels("caster", 1, {}), ElementsAre("id"));
    EXPECT_THAT(exrChannels("concentration", 3, {}), ElementsAre("R", "G", "B"));
    EXPECT_THAT(exrChannels("concentration", 2, {450.0, 587.561}), ElementsAre("T.450,00nm", "T.587,56nm"));
}

connection::Image floatImage(int width, int height, int bands, const std::vector<float>& values) {
    connection::Image image{width, height, bands, protocol::Sample::F32, 1.0f, {}};
    image.data.resize(4 * values.size());
    std::memcpy(image.data.data(), values.data(), image.data.size());
    return image;
}

TEST(Exr, HoldsEveryBitOfEveryChannel) {
    const std::string path = temporary("test.exr");
    const std::vector<float> values = {1.5f, -2.0f, 3.1e-30f, INFINITY, 0.1f, 7.0f};   // 3 x 1, two bands
    ASSERT_TRUE(writeExr(path, floatImage(3, 1, 2, values), {"T.450,00nm", "T.500,00nm"}));
    Imf::InputFile in(path.c_str());
    EXPECT_EQ(in.header().compression(), Imf::ZIP_COMPRESSION);
    std::vector<float> read(3);
    for (const std::size_t band : {0u, 1u}) {
        Imf::FrameBuffer pixels;
        pixels.insert(band == 0 ? "T.450,00nm" : "T.500,00nm", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(read.data()), 4, 12));
        in.setFrameBuffer(pixels);
        in.readPixels(0, 0);
        for (std::size_t x = 0; x < 3; ++x) EXPECT_EQ(read[x], values[2 * x + band]);
    }
    std::filesystem::remove(path);
    EXPECT_FALSE(writeExr("/no/such/folder/x.exr", floatImage(3, 1, 2, values), {"Z", "Y"})) << "said, not thrown";
}

TEST(Exr, CastersAreWholeNumbers) {
    const std::string path = temporary("ids.exr");
    ASSERT_TRUE(writeExr(path, floatImage(2, 2, 1, {0, 1, 2, 300}), {"id"}));
    Imf::InputFile in(path.c_str());
    std::vector<std::uint32_t> read(4);
    Imf::FrameBuffer pixels;
    pixels.insert("id", Imf::Slice(Imf::UINT, reinterpret_cast<char*>(read.data()), 4, 8));
    in.setFrameBuffer(pixels);
    in.readPixels(0, 1);
    EXPECT_THAT(read, ElementsAre(0, 1, 2, 300));
    std::filesystem::remove(path);
}

// A camera at 0 2 5 that looks down -z with 90 degrees: one metre to the right and up at a depth of two is half of the way
// from the middle to the edge.
TEST(CameraMatrix, ProjectsAsThePictureDoes) {
    const Json made = cameraMatrix({{"camera", {{"eye", {0, 2, 5}}, {"target", {0, 2, 0}}, {"up", {0, 1, 0}}, {"fov_y_deg", 90}}},
                                    {"stream", {{"width", 200}, {"height", 100}}}});
    const std::array<double, 4> world = {1, 3, 3, 1};
    std::array<double, 3> at{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t i = 0; i < 4; ++i) at[row] += made["world_to_camera"][row][i].get<double>() * world[i];
    EXPECT_NEAR(-at[2], 2.0, 1e-12) << "the depth";
    EXPECT_NEAR(made["cx"].get<double>() + made["fx"].get<double>() * at[0] / -at[2], 125.0, 1e-9);
    EXPECT_NEAR(made["cy"].get<double>() - made["fy"].get<double>() * at[1] / -at[2], 25.0, 1e-9);
    // Straight down, where `up` says nothing
    const Json down = cameraMatrix({{"camera", {{"eye", {0, 2, 0}}, {"target", {0, 0, 0}}, {"up", {0, 1, 0}}, {"fov_y_deg", 90}}}});
    for (const Json& row : down["world_to_camera"])
        for (const Json& value : row) EXPECT_TRUE(std::isfinite(value.get<double>()));
}

tl::expected<Log, std::string> logOf(const std::string& text) {
    std::istringstream in(text);
    return readLog(in);
}
const std::string kHead = "{\"caustream_log\": 1, \"build\": \"1\", \"state\": {\"scene\": [\"builtin\", \"gem\"]}}\n";

TEST(Log, HasStepsInOrderAndTheAnswersWithTheirRequests) {
    const auto log = logOf(kHead + "{\"op\": \"input\", \"seq\": 4, \"t_us\": 10, \"patch\": {\"camera\": {}}}\n"
                                   "{\"op\": \"frame.request\", \"id\": 9, \"still\": true, \"converge\": false, \"t_us\": 20}\n"
                                   "{\"op\": \"update\", \"patch\": {}, \"t_us\": 25}\n"
                                   "{\"op\": \"frame\", \"id\": 9, \"map_hash\": \"0123456789abcdef\", \"photons\": 77, \"t_us\": 30}\n"
                                   "{\"op\": \"end\", \"reason\": \"\", \"t_us\": 40}\n");
    ASSERT_TRUE(log) << log.error();
    ASSERT_EQ(log->steps.size(), 3u);
    EXPECT_EQ(log->steps[0].kind, LogStep::Kind::Input);
    EXPECT_EQ(log->steps[0].seq, 4u);
    EXPECT_EQ(log->steps[0].number, 2);
    EXPECT_EQ(log->steps[1].mapHash, "0123456789abcdef");
    EXPECT_EQ(log->steps[1].photons, 77u);
    EXPECT_TRUE(log->steps[1].still);
    EXPECT_EQ(log->steps[2].kind, LogStep::Kind::Update);
    EXPECT_TRUE(log->ended);
}

TEST(Log, OfAServerThatWasKilledEndsWithItsLastWholeLine) {
    const auto log = logOf(kHead + "{\"op\": \"update\", \"patch\": {}}\n{\"op\": \"upda");
    ASSERT_TRUE(log) << log.error();
    EXPECT_EQ(log->steps.size(), 1u);
    EXPECT_FALSE(log->ended);
}

TEST(Log, SaysWhichLineIsNoLogs) {
    EXPECT_FALSE(logOf(""));
    EXPECT_THAT(logOf("{}\n").error(), HasSubstr("line 1"));
    EXPECT_THAT(logOf("{\"caustream_log\": 2, \"state\": {}}\n").error(), HasSubstr("another version"));
    EXPECT_THAT(logOf("{\"caustream_log\": 1}\n").error(), HasSubstr("document"));
    EXPECT_THAT(logOf(kHead + "{\"op\": \"upda\n{}\n").error(), HasSubstr("line 2"));
    EXPECT_THAT(logOf(kHead + "{\"op\": \"fly\"}\n").error(), HasSubstr("fly"));
    EXPECT_THAT(logOf(kHead + "{\"op\": \"frame\", \"id\": 3}\n").error(), HasSubstr("not there"));
    EXPECT_THAT(logOf(kHead + "{\"op\": \"input\", \"patch\": 3}\n").error(), HasSubstr("patch"));
}

}  // namespace
}  // namespace caustream::shot
