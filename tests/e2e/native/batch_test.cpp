// caustream-shot --batch and --replay against the real server: data sets that come out the same however they were made.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "pixels.h"
#include "program.h"
#include "tests/e2e/raw_client.h"

namespace caustream::e2e {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

std::string textOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
json jsonOf(const fs::path& file) { return json::parse(textOf(file), nullptr, false); }
std::vector<json> linesOf(const fs::path& file) {
    std::ifstream in(file);
    std::vector<json> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(json::parse(line, nullptr, false));
    return lines;
}

// Every file by name, JSON without the time it took.
std::map<std::string, std::string> contentOf(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename();
        if (entry.path().extension() != ".json") {
            files[name] = textOf(entry.path());
            continue;
        }
        json about = jsonOf(entry.path());
        about.erase("timing");
        files[name] = about.dump();
    }
    return files;
}
void expectSame(const fs::path& a, const fs::path& b) {
    const auto one = contentOf(a), other = contentOf(b);
    std::vector<std::string> differing;
    for (const auto& [name, bytes] : one)
        if (!other.contains(name) || other.at(name) != bytes) differing.push_back(name);
    EXPECT_THAT(differing, testing::IsEmpty());
    EXPECT_EQ(one.size(), other.size());
}

class Batch : public testing::Test {
 protected:
    static void SetUpTestSuite() { server_ = std::make_unique<Server>(); }
    static void TearDownTestSuite() { server_.reset(); }

    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
        return folder_ / name;
    }
    // A batch of small pictures of the sphere on `server`.
    static std::vector<std::string> arguments(const Server& server, const std::string& lines, const std::string& out, std::vector<std::string> more = {}) {
        std::vector<std::string> all = {"--url", server.url(), "--scene", "sphere", "--width", "96", "--height", "64", "--set",
                                        "transport.map_size=128", "--batch", lines, "--out", out};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    static Result shoot(const std::vector<std::string>& arguments) { return run(CAUSTREAM_BIN "/caustream-shot", arguments); }
    // The light moves from line to line.
    static std::string poses(int count) {
        std::string lines;
        for (int i = 0; i < count; ++i) {
            const double x = -0.6 + 0.2 * i;
            lines += json{{"name", "pose" + std::to_string(i)}, {"patch", {{"lights", {{"key", {{"position", {x, 1.9, 0.2}}, {"direction", {-x, -1.4, -0.2}}}}}}}}}.dump() + "\n";
        }
        return lines;
    }

    static std::unique_ptr<Server> server_;
    TemporaryFolder folder_;
};
std::unique_ptr<Server> Batch::server_;

TEST_F(Batch, HoldsEachTargetInEachFormat) {
    const std::string lines = write("one.jsonl", R"({"name": "all", "patch": {"transport": {"wavelengths": 5}},
 "targets": ["composite", "spectral", "bands", "depth", "normals", "caster_mask"]})");
    std::string one = textOf(lines);
    std::erase(one, '\n');
    write("one.jsonl", one);
    const Result result = shoot(arguments(*server_, lines, folder_ / "set", {"--format", "png,npy,exr"}));
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const fs::path set = folder_ / "set";
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(set)) names.insert(entry.path().filename());
    std::set<std::string> expected = {"all.json", "index.jsonl"};
    for (const char* target : {"composite", "spectral", "bands", "depth", "normals", "caster_mask"}) {
        for (const char* ending : {"npy", "exr"}) expected.insert(std::string("all.") + target + "." + ending);
    }
    for (const char* target : {"composite", "normals", "caster_mask"}) expected.insert(std::string("all.") + target + ".png");
    EXPECT_EQ(names, expected);

    const json about = jsonOf(set / "all.json");
    EXPECT_EQ(about["targets"]["bands"]["wavelengths_nm"].size(), 5u);
    EXPECT_EQ(about["targets"]["depth"]["unit"], "m");
    EXPECT_EQ(about["targets"]["spectral"]["light_matrix"].size(), 4u);
    EXPECT_EQ(about["targets"]["composite"]["map_hash"].get<std::string>().size(), 16u);
    EXPECT_GT(about["targets"]["composite"]["ledger"]["on_casters"], 0.0);
    EXPECT_GT(about["targets"]["composite"]["error"]["total"], 0.0);
    EXPECT_EQ(about["state"]["transport"]["wavelengths"], 5);
    EXPECT_TRUE(about["state"]["lights"]["key"].contains("position")) << "resolved: as the file has it";
    EXPECT_EQ(readNpy(set / "all.bands.npy").bands, 5);

    // Depths, normals and the camera say the same: where the normal is up and no glass stands, all points lie on one level.
    const Pixels depth = readNpy(set / "all.depth.npy"), normals = readNpy(set / "all.normals.npy"), mask = readNpy(set / "all.caster_mask.npy");
    ASSERT_EQ(depth.bands, 1);
    ASSERT_EQ(normals.bands, 3);
    const json camera = about["camera"];
    int floor = 0, glass = 0;
    double least = 1e9, most = -1e9;
    for (int y = 0; y < depth.height; ++y) {
        for (int x = 0; x < depth.width; ++x) {
            const auto i = static_cast<std::size_t>(y * depth.width + x);
            glass += mask.values[i] == 1.0f;
            if (mask.values[i] != 0.0f || normals.values[3 * i + 1] < 0.9999f) continue;
            const double z = depth.values[i], at[3] = {(x + 0.5 - camera["cx"].get<double>()) / camera["fx"].get<double>() * z,
                                                       (camera["cy"].get<double>() - y - 0.5) / camera["fy"].get<double>() * z, -z};
            double height = 0.0;   // row 1 of the inverse of a rigid matrix: its column 1
            for (std::size_t k = 0; k < 3; ++k) {
                height += camera["world_to_camera"][k][1].get<double>() * (at[k] - camera["world_to_camera"][k][3].get<double>());
            }
            least = std::min(least, height), most = std::max(most, height);
            ++floor;
        }
    }
    EXPECT_GT(floor, 200);
    EXPECT_GT(glass, 50);
    EXPECT_LT(most - least, 1e-4) << "of a floor some metres away";
    const Pixels grey = readPng(set / "all.caster_mask.png");
    EXPECT_EQ(std::ranges::count_if(grey.values, [](float v) { return v == 1.0f; }), glass * static_cast<std::ptrdiff_t>(grey.bands)) << "the number itself is the grey level";
}

TEST_F(Batch, ComesToTheSameBitsOverHoweverManyConnections) {
    // One light on flat facets, which are traced always: lines that converge must not lend their photons to stills, nor
    // their pictures' samples to each other.
    std::string lines;
    const auto add = [&](const char* name, bool converge, double fov, json targets) {
        lines += json{{"name", name}, {"converge", converge}, {"targets", std::move(targets)},
                      {"patch", {{"scene", {"builtin", "gem"}}, {"camera", {{"fov_y_deg", fov}}}, {"transport", {{"target_error", 0.12}}}}}}.dump() + "\n";
    };
    add("c0", true, 40, {"composite"});
    for (const char* name : {"s0", "s1", "s2", "s3"}) add(name, false, 30.0 + name[1], {"composite", "spectral"});
    add("c1", true, 40, {"composite", "spectral", "normals"});
    add("c2", true, 35, {"bands", "composite"});
    const std::string file = write("mix.jsonl", lines + poses(2));
    ASSERT_EQ(shoot(arguments(*std::make_unique<Server>(), file, folder_ / "one")).exitCode, 0);
    ASSERT_EQ(shoot(arguments(*std::make_unique<Server>(), file, folder_ / "four", {"--connections", "4"})).exitCode, 0);
    expectSame(folder_ / "one", folder_ / "four");
    EXPECT_TRUE(jsonOf(folder_ / "one/c0.json")["targets"]["composite"]["convergence"]["converged"]);
    EXPECT_EQ(jsonOf(folder_ / "one/s0.json")["targets"]["composite"]["map_hash"], jsonOf(folder_ / "one/s3.json")["targets"]["spectral"]["map_hash"]);
    EXPECT_EQ(linesOf(folder_ / "one/index.jsonl").size(), 9u);
}

TEST_F(Batch, GoesOnAfterItWasKilled) {
    const std::string lines = write("poses.jsonl", poses(6));
    ASSERT_EQ(shoot(arguments(*server_, lines, folder_ / "whole")).exitCode, 0);
    const fs::path cut = folder_ / "cut";
    {
        Background batch(CAUSTREAM_BIN "/caustream-shot", arguments(*server_, lines, cut, {"--connections", "2"}));
        for (int i = 0; i < 3000 && !fs::exists(cut / "pose1.json"); ++i) usleep(10'000);
        batch.stop(SIGKILL);
    }
    ASSERT_TRUE(fs::exists(cut / "pose1.json"));
    const auto written = fs::last_write_time(cut / "pose1.json");
    // As a kill within a file leaves it, and a file that someone took away.
    write("cut/.pose5.composite.png.part", "half");
    fs::remove(cut / "pose0.composite.exr");
    const Result result = shoot(arguments(*server_, lines, cut));
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_THAT(result.out, testing::Not(HasSubstr("6 drawn")));
    EXPECT_EQ(fs::last_write_time(cut / "pose1.json"), written) << "what is there is left alone";
    expectSame(folder_ / "whole", cut);

    const Result again = shoot(arguments(*server_, lines, cut));
    EXPECT_EQ(again.exitCode, 0);
    EXPECT_THAT(again.out, HasSubstr("0 drawn, 6 there already"));
    const Result forced = shoot(arguments(*server_, lines, cut, {"--force"}));
    EXPECT_THAT(forced.out, HasSubstr("6 drawn, 0 there already"));
    const Result other = shoot(arguments(*server_, lines, cut, {"--set", "camera.fov_y_deg=35"}));
    EXPECT_THAT(other.out, HasSubstr("6 drawn")) << "asked for otherwise";
    EXPECT_EQ(other.exitCode, 0);
}

TEST_F(Batch, WaitsForAServerThatIsStartedAgain) {
    const std::string lines = write("poses.jsonl", poses(6));
    ASSERT_EQ(shoot(arguments(*server_, lines, folder_ / "whole")).exitCode, 0);
    auto first = std::make_unique<Server>();
    const std::string port = first->port();
    Background batch(CAUSTREAM_BIN "/caustream-shot", arguments(*first, lines, folder_ / "set", {"--connections", "2"}));
    for (int i = 0; i < 3000 && !fs::exists(folder_ / "set/pose1.json"); ++i) usleep(10'000);
    first->kill();
    EXPECT_FALSE(fs::exists(folder_ / "set/index.jsonl")) << "it was not done before";
    const Server second({"--port", port});
    EXPECT_TRUE(batch.ends()) << "with exit code 0";
    expectSame(folder_ / "whole", folder_ / "set");
}

TEST_F(Batch, StopsBetweenTwoFilesAndGoesOn) {
    const std::string lines = write("poses.jsonl", poses(40));
    {
        Background batch(CAUSTREAM_BIN "/caustream-shot", arguments(*server_, lines, folder_ / "set"));
        for (int i = 0; i < 3000 && !fs::exists(folder_ / "set/pose0.json"); ++i) usleep(10'000);
        EXPECT_EQ(batch.stop(SIGINT), 130);
    }
    for (const auto& entry : fs::directory_iterator(folder_ / "set")) EXPECT_NE(entry.path().extension(), ".part");
    const auto listed = linesOf(folder_ / "set/index.jsonl");
    ASSERT_EQ(listed.size(), 40u);
    EXPECT_EQ(listed.front()["status"], "done");
    EXPECT_EQ(listed.back()["status"], "pending");
}

TEST_F(Batch, BadLinesAreNamedAndTheOthersDrawn) {
    const std::string lines = write("bad.jsonl", "{\"name\": \"good\"}\n{\"patch\": {\"camera\": {\"fov_y_deg\": \"wide\"}}}\n"
                                                 "{\"patch\": {\"lights\": {\"nobody\": {\"position\": [0, 1, 0]}}}}\nnot JSON\n{\"name\": \"last\"}\n");
    const Result result = shoot(arguments(*server_, lines, folder_ / "set", {"--format", "png"}));
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.err, HasSubstr("bad.jsonl:2: patch.camera.fov_y_deg: "));
    EXPECT_THAT(result.err, HasSubstr("bad.jsonl:3: patch.lights.nobody: "));
    EXPECT_THAT(result.err, HasSubstr("bad.jsonl:4: "));
    EXPECT_TRUE(fs::exists(folder_ / "set/good.composite.png"));
    EXPECT_TRUE(fs::exists(folder_ / "set/last.composite.png"));
    std::vector<std::string> statuses;
    for (const json& line : linesOf(folder_ / "set/index.jsonl")) statuses.push_back(line["status"]);
    EXPECT_THAT(statuses, testing::ElementsAre("done", "failed", "failed", "failed", "done"));
}

TEST_F(Batch, SaysWhyItCannotRun) {
    const std::string lines = write("one.jsonl", "{}\n");
    const auto expectCannot = [](const Result& result, const std::string& part) {
        EXPECT_EQ(result.exitCode, 1);
        EXPECT_THAT(result.err, HasSubstr(part));
    };
    expectCannot(shoot(arguments(*server_, folder_ / "none.jsonl", folder_ / "set")), "none.jsonl");
    expectCannot(shoot(arguments(*server_, lines, folder_ / "set", {"--format", "png,bmp"})), "bmp");
    expectCannot(shoot(arguments(*server_, lines, folder_ / "set", {"--connections", "9"})), "--connections");
    expectCannot(shoot(arguments(*server_, lines, folder_ / "set", {"--set", "camera.fov=3"})), "fov");
    expectCannot(shoot(arguments(*server_, lines, folder_ / "one.jsonl/set")), "cannot make the folder");
    expectCannot(run(CAUSTREAM_BIN "/caustream-shot", {"--url", "http://127.0.0.1:1", "--batch", lines, "--out", folder_ / "set"}),
                 "is caustream-server running");
}

TEST_F(Batch, ASceneCanBeAFile) {
    fs::copy_file(CAUSTREAM_SPHERE_GLB, folder_ / "mine.glb");
    const std::string lines = write("files.jsonl", R"({"name": "file", "patch": {"scene": ["file", "mine.glb"]}, "targets": ["depth"]})" "\n"
                                                   R"({"name": "builtin", "targets": ["depth"]})" "\n");
    const Result result = shoot(arguments(*server_, lines, folder_ / "set", {"--format", "npy"}));
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(textOf(folder_ / "set/file.depth.npy"), textOf(folder_ / "set/builtin.depth.npy")) << "it is the same scene";
    EXPECT_EQ(jsonOf(folder_ / "set/file.json")["state"]["scene"][0], "asset");
}

TEST_F(Batch, ASingleShotCanBeExr) {
    const std::string file = folder_ / "depth.exr";
    const Result result = shoot({"--url", server_->url(), "--scene", "sphere", "--width", "64", "--height", "64", "--target", "depth", "--out", file});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(textOf(file).substr(0, 4), "\x76\x2f\x31\x01") << "OpenEXR's magic number";
    EXPECT_EQ(jsonOf(file + ".json")["stream_info"]["unit"], "m");
}

// A session recorded, and played twice to servers that know nothing of it.
TEST_F(Batch, AReplayComesToTheSameBitsAndToTheMapsOfThen) {
    const fs::path logs = folder_ / "logs";
    fs::create_directory(logs);
    std::string name;
    {
        Server recording({"--port", "0", "--record-dir", logs});
        RawClient client(std::stoi(recording.port()));
        EXPECT_THAT(client.hello()["caps"], testing::Contains(json("record")));
        client.update({{"scene", {"builtin", "sphere"}}, {"transport", {{"map_size", 128}}}, {"stream", {{"width", 96}, {"height", 64}}}});
        const json reply = client.ask({{"op", "record"}, {"on", true}});
        name = reply.value("recording", "");
        ASSERT_FALSE(name.empty()) << reply;
        for (int i = 1; i <= 3; ++i) {
            client.json({{"op", "input"}, {"seq", i}, {"t_us", i}, {"lights", {{"key", {{"position", {-0.6 + 0.2 * i, 1.9, 0.2}}}}}}});
            client.ack(client.requestFrame(i == 3).header.frameSeq);
        }
        client.update({{"camera", {{"fov_y_deg", 200}}}});   // refused
        client.update({{"camera", {{"fov_y_deg", 35}}}});
        client.ack(client.requestFrame(true).header.frameSeq);
        EXPECT_FALSE(client.ask({{"op", "record"}, {"on", false}}).contains("recording"));
        client.update({{"camera", {{"fov_y_deg", 45}}}});    // no longer recorded
    }
    const std::string log = logs / name;
    EXPECT_EQ(linesOf(log).size(), 1u + 3 * 3 + 3 + 1) << "header; input, request, answer; update, request, answer; end";
    const auto play = [&](const std::string& out, std::vector<std::string> more = {}) {
        const Server server;
        more.insert(more.begin(), {"--url", server.url(), "--replay", log, "--out", folder_ / out});
        return shoot(more);
    };
    const Result first = play("first"), second = play("second");
    ASSERT_EQ(first.exitCode, 0) << first.err;
    ASSERT_EQ(second.exitCode, 0) << second.err;
    expectSame(folder_ / "first", folder_ / "second");
    int compared = 0, pictures = 0;
    for (const json& line : linesOf(folder_ / "first/report.jsonl")) {
        compared += line.value("same", json()) == true;
        ++pictures;
        EXPECT_TRUE(fs::exists(folder_ / ("first/" + line["file"].get<std::string>())));
    }
    EXPECT_EQ(pictures, 8) << "one after each of four changes, and the four that were asked for";
    EXPECT_EQ(compared, 2) << "stills count their map's hash";
    const Result few = play("few", {"--every", "4"});
    EXPECT_EQ(few.exitCode, 0) << few.err;
    EXPECT_EQ(linesOf(folder_ / "few/report.jsonl").size(), 5u);

    // A log of another map
    std::string text = textOf(log);
    const json last = linesOf(folder_ / "first/report.jsonl").back();
    const auto at = text.rfind(last["map_hash"].get<std::string>());
    ASSERT_NE(at, text.npos);
    text[at] = text[at] == '0' ? '1' : '0';
    std::ofstream(log) << text;
    const Result other = play("other");
    EXPECT_EQ(other.exitCode, 2);
    EXPECT_THAT(other.err, HasSubstr("the map is " + last["map_hash"].get<std::string>()));
}

TEST_F(Batch, AServerWithoutAFolderForItRecordsNothing) {
    RawClient client(std::stoi(server_->port()));
    client.hello();
    const json reply = client.ask({{"op", "record"}, {"on", true}});
    EXPECT_EQ(reply["code"], "unsupported");
    EXPECT_THAT(reply["message"].get<std::string>(), HasSubstr("--record-dir"));
}

}  // namespace
}  // namespace caustream::e2e
