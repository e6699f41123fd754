// A file sent in chunks becomes a scene; a file that is not what it says is refused, and nothing else suffers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "raw_client.h"
#include "server_process.h"
#include "uploader.h"

namespace caustream::e2e {
namespace {

using testing::HasSubstr;

const Json kSmall = {{"transport", {{"photon_grid", 64}, {"map_size", 64}}}, {"stream", {{"width", 64}, {"height", 64}}}};
constexpr std::size_t kChunk = 100'000;

class Upload : public testing::Test {
   protected:
    Upload() {
        viewer_.hello();
        viewer_.update(kSmall);
    }

    Json begin(std::string_view file, const std::string& hash) { return beginUpload(viewer_, file, hash); }
    Json send(std::string_view file, const std::string& hash) { return upload(viewer_, file, hash); }
    Json send(std::string_view file) { return upload(viewer_, file); }

    ServerProcess server_;
    RawClient viewer_{server_.port()};
};

TEST_F(Upload, AFileBecomesTheSceneItIs) {
    const std::string file = builtinGlb("gem");
    ASSERT_FALSE(file.empty());
    const Json report = send(file);
    ASSERT_EQ(report["op"], "ok") << report;
    EXPECT_GT(report["triangles"], 0);
    viewer_.update({{"stream", {{"encoding", "raw"}}}});
    ASSERT_EQ(viewer_.update({{"scene", {"asset", sha256(file)}}})["op"], "ok");
    const Picture uploaded = viewer_.requestFrame();
    viewer_.update({{"scene", {"builtin", "gem"}}});
    EXPECT_EQ(viewer_.requestFrame().payload, uploaded.payload);

    // The server knows it now: another viewer need not send it.
    RawClient other(server_.port());
    other.hello();
    const Json offer =
        other.ask({{"op", "asset.begin"}, {"sha256", sha256(file)}, {"size", file.size()}, {"mime", "model/gltf-binary"}});
    EXPECT_EQ(offer["have"], file.size());
    EXPECT_EQ(other.ask({{"op", "asset.end"}, {"asset", offer["asset"]}})["op"], "ok");
    EXPECT_EQ(other.update({{"scene", {"asset", sha256(file)}}})["op"], "ok");
}

TEST_F(Upload, AFileLargerThanTheCreditArrives) {
    const std::string file = padded(builtinGlb("gem"), 2'000'000);
    const Json report = send(file);
    EXPECT_EQ(report["op"], "ok") << report;
}

TEST_F(Upload, FilesThatAreNotWhatTheySay) {
    const std::string file = builtinGlb("gem");
    const std::string header(file, 0, 12);
    const std::vector<std::pair<std::string, std::string>> battery = {
        {"cut short", file.substr(0, file.size() / 2)},
        {"header only", header},
        {"no GLB", std::string(5000, 'z')},
        {"lies about its length", file.substr(0, 8) + std::string("\xff\xff\xff\x7f", 4) + file.substr(12)},
        {"lies about a chunk", file.substr(0, 12) + std::string("\xff\xff\xff\xff", 4) + file.substr(16)},
    };
    for (const auto& [what, bytes] : battery) {
        const Json error = send(bytes);
        EXPECT_EQ(error["op"], "error") << what;
        EXPECT_EQ(error["code"], "asset_invalid") << what;
        EXPECT_FALSE(error["message"].get<std::string>().empty()) << what;
        EXPECT_EQ(viewer_.update({{"scene", {"asset", sha256(bytes)}}})["code"], "asset_missing") << what;
    }
    viewer_.requestFrame();
}

TEST_F(Upload, ChunksAreCheckedAndCanBeSentAgain) {
    const std::string file = builtinGlb("gem");
    const Json offer = begin(file, sha256(file));
    const std::uint32_t asset = offer["asset"];
    const auto refusal = [&](const std::vector<std::uint8_t>& chunk) {
        viewer_.binary(chunk);
        return viewer_.textOf("error", 10'000).value_or(Json::object());
    };
    EXPECT_EQ(refusal(chunkOf(asset, file, 100, 100))["code"], "bad_offset");
    std::vector<std::uint8_t> broken = chunkOf(asset, file, 0, 100);
    broken.back() ^= 1;
    EXPECT_EQ(refusal(broken)["field"], "crc32");
    EXPECT_EQ(begin(file, sha256(file))["code"], "busy") << "one upload at a time";
    for (std::size_t at = 0; at < file.size(); at += kChunk) {
        viewer_.binary(chunkOf(asset, file, at, kChunk));
    }
    EXPECT_EQ(viewer_.ask({{"op", "asset.end"}, {"asset", asset}})["op"], "ok");
}

TEST_F(Upload, HashLengthAndSizeAreKept) {
    const std::string file = builtinGlb("gem");
    EXPECT_EQ(send(file, std::string(64, 'b'))["field"], "sha256");
    const Json offer = begin(file, sha256(file));
    viewer_.binary(chunkOf(offer["asset"], file, 0, 1000));
    const Json error = viewer_.ask({{"op", "asset.end"}, {"asset", offer["asset"]}});
    EXPECT_EQ(error["field"], "size");
    const Json tooLarge =
        viewer_.ask({{"op", "asset.begin"}, {"sha256", std::string(64, 'c')}, {"size", 65u << 20}, {"mime", "model/gltf-binary"}});
    EXPECT_EQ(tooLarge["op"], "error");
    EXPECT_EQ(tooLarge["field"], "size");
    const Json again = begin(file, sha256(file));
    ASSERT_EQ(again["op"], "ok");
    viewer_.json({{"op", "asset.abort"}, {"asset", again["asset"]}});
    EXPECT_EQ(send(file)["op"], "ok") << "an aborted upload leaves room for the next";
}

}  // namespace
}  // namespace caustream::e2e
