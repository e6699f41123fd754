// caustream-shot against the real server: what lies in its files, and what it says when there is nothing to put there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "pixels.h"
#include "program.h"

namespace caustream::e2e {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

// One server for all: every shot is a session of its own.
class Shot : public testing::Test {
 protected:
    static void SetUpTestSuite() { server_ = std::make_unique<Server>(); }
    static void TearDownTestSuite() { server_.reset(); }

    Result shoot(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"--url", server_->url()});
        return run(CAUSTREAM_BIN "/caustream-shot", arguments);
    }
    static json readJson(const std::string& file) {
        std::ifstream in(file);
        return json::parse(std::string{std::istreambuf_iterator<char>(in), {}}, nullptr, false);
    }
    static void expectOneLine(const Result& result, const std::string& part) {
        EXPECT_EQ(result.exitCode, 1);
        EXPECT_THAT(result.err, StartsWith("caustream-shot: "));
        EXPECT_THAT(result.err, HasSubstr(part));
        EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    }

    static std::unique_ptr<Server> server_;
    TemporaryFolder folder_;
};
std::unique_ptr<Server> Shot::server_;

TEST_F(Shot, PngHoldsACaustic) {
    const std::string file = folder_ / "sphere.png";
    const Result result = shoot({"--scene", "sphere", "--width", "256", "--height", "192", "--out", file});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const Pixels picture = readPng(file);
    EXPECT_EQ(picture.width, 256);
    EXPECT_EQ(picture.height, 192);
    EXPECT_GT(picture.quantile(0.999), 200.0);
    EXPECT_LT(picture.quantile(0.5), 0.7 * picture.quantile(0.999));
    EXPECT_GT(picture.quantile(0.5), 5.0) << "shadows are not black";

    const json report = readJson(file + ".json");
    EXPECT_EQ(report["stream_info"]["target"], "composite");
    EXPECT_EQ(report["header"]["encoding"], "raw") << "never through JPEG";
    EXPECT_EQ(report["map_hash"].get<std::string>().size(), 16u);
    EXPECT_EQ(report["statistics"]["frames"], 1);
}

TEST_F(Shot, NpyHoldsTheFiniteSpectralMap) {
    const std::string file = folder_ / "map.npy";
    const Result result =
        shoot({"--scene", "sphere", "--target", "spectral", "--set", "transport.map_size=256", "--out", file});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const Pixels map = readNpy(file);
    EXPECT_EQ(map.width, 256);
    EXPECT_EQ(map.height, 256);
    EXPECT_EQ(map.bands, 3);
    for (const float value : map.values) ASSERT_TRUE(std::isfinite(value));
    EXPECT_GT(map.quantile(0.9999), 3.0) << "a sphere gathers light to several times what falls on it";
    EXPECT_GE(map.quantile(0.0), -1e-5) << "no light is 0, but for the colour matrix's rounding";

    const json report = readJson(file + ".json");
    EXPECT_EQ(report["stream_info"]["unit"], "concentration");
    EXPECT_EQ(report["values"]["not_finite"], 0);
    EXPECT_EQ(report["stream_info"]["wavelengths_nm"].size(), 4u) << "the exact ones of a continuous spectrum";
}

TEST_F(Shot, NpyHoldsABandPerWavelength) {
    const std::string file = folder_ / "bands.npy";
    const Result result =
        shoot({"--scene", "sphere", "--target", "spectral", "--set", "stream.bands=wavelengths", "--set",
               "/transport/wavelengths=5", "--set", "transport.map_size=128", "--out", file});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(readNpy(file).bands, 5);
}

TEST_F(Shot, NpyHoldsALinearPicture) {
    const std::string file = folder_ / "linear.npy";
    const Result result = shoot({"--scene", "sphere", "--width", "128", "--height", "128", "--out", file});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const Pixels picture = readNpy(file);
    EXPECT_EQ(picture.bands, 3);
    for (const float value : picture.values) ASSERT_TRUE(std::isfinite(value) && value >= 0.0f);
    EXPECT_GT(picture.quantile(0.999), picture.quantile(0.5));
}

TEST_F(Shot, JpegIsThePngButForItsLosses) {
    const std::string jpeg = folder_ / "gem.jpg", png = folder_ / "gem.png";
    const std::vector<std::string> common = {"--scene", "gem", "--width", "192", "--height", "192"};
    for (const auto& file : {jpeg, png}) {
        std::vector<std::string> arguments = common;
        arguments.insert(arguments.end(), {"--out", file});
        const Result result = shoot(arguments);
        ASSERT_EQ(result.exitCode, 0) << result.err;
    }
    const Pixels a = readJpeg(jpeg), b = readPng(png);
    ASSERT_EQ(a.values.size(), b.values.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < a.values.size(); ++i) sum += std::abs(a.values[i] - b.values[i]);
    EXPECT_LT(sum / static_cast<double>(a.values.size()), 4.0) << "quality 95 at 4:2:0 or better loses less";
    EXPECT_EQ(readJson(jpeg + ".json")["map_hash"], readJson(png + ".json")["map_hash"]);
}

TEST_F(Shot, MovesTheLightWithTheStream) {
    const std::string file = folder_ / "moving-#.jpg";
    const Result result =
        shoot({"--scene", "sphere", "--width", "96", "--height", "96", "--moving", "--frames", "4", "--out", file});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const Pixels first = readJpeg(folder_ / "moving-0000.jpg"), last = readJpeg(folder_ / "moving-0003.jpg");
    double change = 0.0;
    for (std::size_t i = 0; i < first.values.size(); ++i)
        change = std::max<double>(change, std::abs(first.values[i] - last.values[i]));
    EXPECT_GT(change, 40.0) << "the light stood still";
    EXPECT_TRUE(readJson(folder_ / "moving-0003.jpg.json")["statistics"]["took_ms"].contains("median"));
}

TEST_F(Shot, ShowsAPass) {
    const std::string file = folder_ / "pass.png";
    const Result result = shoot({"--scene", "sphere", "--target", "caster_layers", "--out", file});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_GT(readPng(file).quantile(0.999), 50.0);
}

TEST_F(Shot, SendsAFile) {
    const std::string file = folder_ / "sent.png", builtin = folder_ / "builtin.png";
    ASSERT_EQ(shoot({"--scene", CAUSTREAM_SPHERE_GLB, "--width", "64", "--height", "64", "--out", file}).exitCode, 0);
    ASSERT_EQ(shoot({"--scene", "sphere", "--width", "64", "--height", "64", "--out", builtin}).exitCode, 0);
    EXPECT_EQ(readPng(file).values, readPng(builtin).values)
        << "the same file gives the same picture, whichever way it came";
}

TEST_F(Shot, SameStateSameMap) {
    const std::string file = folder_ / "again.png";
    const Result result =
        shoot({"--scene", "sphere", "--width", "64", "--height", "64", "--frames", "3", "--out", file});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const json hashes = readJson(file + ".json")["map_hashes"];
    ASSERT_EQ(hashes.size(), 3u);
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

TEST_F(Shot, WaitsUntilAPictureHasConverged) {
    const std::vector<std::string> traced = {"--scene", "gem", "--width", "96", "--height", "96", "--set", "transport.mode=traced",
                                             "--set", "transport.map_size=256", "--set", "transport.photon_grid=64",
                                             "--set", "transport.target_error=0.08"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), traced.begin(), traced.end());
        return shoot(more);
    };
    const std::string quick = folder_ / "quick.png", patient = folder_ / "patient.png", again = folder_ / "again.npy";
    const Result first = with({"--out", quick});
    ASSERT_EQ(first.exitCode, 0) << first.err;
    EXPECT_THAT(first.out, HasSubstr("--converge waits for the rest"));
    const Result result = with({"--converge", "--out", patient});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("photons, error about"));
    EXPECT_THAT(result.out, HasSubstr(", converged"));
    EXPECT_EQ(result.err, "") << "no progress bar where nobody looks";

    const json before = readJson(quick + ".json"), report = readJson(patient + ".json");
    EXPECT_EQ(report["header"]["flags"], 5) << "STILL and CONVERGED";
    const json reached = report["server_stats"]["convergence"];
    EXPECT_EQ(reached["converged"], true);
    EXPECT_LE(reached["error"], 0.08);
    EXPECT_GT(reached["photons"], before["server_stats"]["convergence"]["photons"]);
    EXPECT_NE(report["map_hash"], before["map_hash"]);
    EXPECT_GT(readPng(patient).quantile(0.999), 100.0);

    // What has converged for one is there for the next.
    ASSERT_EQ(with({"--converge", "--target", "spectral", "--out", again}).exitCode, 0);
    EXPECT_EQ(readJson(again + ".json")["map_hash"], report["map_hash"]);

    // And what has nothing to converge comes at once.
    const Result refined = shoot({"--scene", "sphere", "--converge", "--set", "transport.mode=refined", "--target", "spectral", "--out", again});
    EXPECT_EQ(refined.exitCode, 0) << refined.err;
}

TEST_F(Shot, SaysWhatIsWrongInOneLine) {
    const std::string file = folder_ / "none.png";
    expectOneLine(shoot({"--scene", "sphere"}), "--out");
    expectOneLine(shoot({"--out", folder_ / "picture.bmp"}), ".png, .npy, .exr or .jpg");
    expectOneLine(shoot({"--out", file, "--scene", "nowhere"}), "nowhere");
    expectOneLine(shoot({"--out", file, "--scene", folder_ / "missing.glb"}), "missing.glb");
    expectOneLine(shoot({"--out", file, "--set", "no-equals-sign"}), "PATH=VALUE");
    expectOneLine(shoot({"--out", file, "--set", "transport.wavelengths=65"}), "transport.wavelengths");
    expectOneLine(shoot({"--out", file, "--set", "transport.wavelenghts=5"}), "wavelenghts");
    expectOneLine(shoot({"--out", file, "--set", "lights.nobody.position=[0,1,0]"}), "no such name");
    expectOneLine(shoot({"--out", file, "--target", "no_such_pass"}), "no_such_pass");
    expectOneLine(shoot({"--out", file, "--width", "7"}), "--width");
    expectOneLine(shoot({"--out", file, "--converge", "--moving"}), "--converge");
    EXPECT_FALSE(std::filesystem::exists(file));

    std::ofstream(folder_ / "cut.glb") << "glTF";
    expectOneLine(shoot({"--out", file, "--scene", folder_ / "cut.glb"}), "asset_invalid");
    expectOneLine(shoot({"--out", folder_ / "no/such/folder.png", "--scene", "sphere"}), "cannot write");
    expectOneLine(run(CAUSTREAM_BIN "/caustream-shot", {"--url", "http://127.0.0.1:1", "--out", file}),
                  "is caustream-server running");
    expectOneLine(run(CAUSTREAM_BIN "/caustream-shot", {"--url", "gopher://127.0.0.1", "--out", file}),
                  "http://host:port");
}

}  // namespace
}  // namespace caustream::e2e
