// Uploaded files beyond one upload: found in the folder that servers share, read with progress, ended, not in others' way.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "raw_client.h"
#include "server_process.h"
#include "uploader.h"

namespace caustream::e2e {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const Json kSmall = {{"transport", {{"photon_grid", 64}, {"map_size", 64}}}, {"stream", {{"width", 64}, {"height", 64}, {"encoding", "raw"}}}};

// Glass of n * n bumps in one mesh: long to read, as every edge looks for its partner.
std::string bumpyGlass(std::uint32_t n) {
    const std::uint32_t vertices = (n + 1) * (n + 1), indices = 6 * n * n;
    std::string binary;
    const auto put = [&](const auto& value) { binary.append(reinterpret_cast<const char*>(&value), sizeof value); };
    for (std::uint32_t i = 0; i < vertices; ++i) {
        put(static_cast<float>(i % (n + 1)) / static_cast<float>(n));
        put(0.001f * static_cast<float>(i * 7919 % 101));
        put(static_cast<float>(i / (n + 1)) / static_cast<float>(n));
    }
    for (std::uint32_t i = 0; i < n * n; ++i) {
        const std::uint32_t a = i / n * (n + 1) + i % n, b = a + 1, c = a + n + 1, d = c + 1;
        for (const std::uint32_t corner : {a, c, b, b, c, d}) {
            put(corner);
        }
    }
    const Json root = {
        {"asset", {{"version", "2.0"}}},
        {"buffers", {{{"byteLength", binary.size()}}}},
        {"bufferViews", {{{"buffer", 0}, {"byteLength", 12 * vertices}}, {{"buffer", 0}, {"byteOffset", 12 * vertices}, {"byteLength", 4 * indices}}}},
        {"accessors",
         {{{"bufferView", 0}, {"componentType", 5126}, {"count", vertices}, {"type", "VEC3"}},
          {{"bufferView", 1}, {"componentType", 5125}, {"count", indices}, {"type", "SCALAR"}}}},
        {"materials", {{{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}}}},
        {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"material", 0}}}}}}},
        {"nodes", {{{"mesh", 0}}}},
        {"scenes", {{{"nodes", {0}}}}}};
    std::string text = root.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string file = "glTF";
    const auto word = [&](std::size_t value) {
        const auto narrow = static_cast<std::uint32_t>(value);
        file.append(reinterpret_cast<const char*>(&narrow), 4);
    };
    word(2);
    word(28 + text.size() + binary.size());
    word(text.size());
    file += "JSON" + text;
    word(binary.size());
    file.append("BIN\0", 4);
    return file + binary;
}

class SharedFolder : public testing::Test {
   protected:
    SharedFolder() {
        std::string name = (fs::temp_directory_path() / "caustream-e2e-XXXXXX").string();
        folder_ = mkdtemp(name.data());
    }
    ~SharedFolder() override { fs::remove_all(folder_); }
    std::vector<std::string> flags() const { return {"--asset-dir", folder_.string()}; }
    fs::path pathOf(std::string_view file) const { return folder_ / (sha256(file) + ".glb"); }

    fs::path folder_;
    const std::string file_ = builtinGlb("prism");
    const Json scene_ = {"asset", sha256(file_)};
};

TEST_F(SharedFolder, AnotherServerShowsAndResumesWhatOneWasGiven) {
    std::vector<std::uint8_t> picture;
    {
        ServerProcess first(flags());
        RawClient viewer(first.port());
        viewer.hello();
        viewer.update(kSmall);
        ASSERT_EQ(upload(viewer, file_)["op"], "ok");
        EXPECT_TRUE(fs::exists(pathOf(file_))) << "at the latest with the reply";
        ASSERT_EQ(viewer.update({{"scene", scene_}})["op"], "ok");
        picture = viewer.requestFrame().payload;
    }
    ServerProcess second(flags());
    RawClient returning(second.port());
    Json state = kSmall;
    state["scene"] = scene_;
    const Json welcome = returning.hello({{"resume", {{"session", "s"}, {"state", state}}}});
    EXPECT_EQ(welcome["missing_assets"], Json::array());
    EXPECT_EQ(welcome["state"]["scene"], scene_);
    EXPECT_EQ(returning.requestFrame().payload, picture);

    ServerProcess third(flags());
    RawClient viewer(third.port());
    viewer.hello();
    EXPECT_EQ(viewer.update({{"scene", scene_}})["op"], "ok") << "by an update";
    ServerProcess fourth(flags());
    RawClient uploader(fourth.port());
    uploader.hello();
    const Json offer = beginUpload(uploader, file_, sha256(file_));
    EXPECT_EQ(offer["have"], file_.size()) << "by asset.begin";
    EXPECT_GT(uploader.ask({{"op", "asset.end"}, {"asset", offer["asset"]}})["triangles"], 0);
}

TEST_F(SharedFolder, WithoutTheFileItIsMissing) {
    ServerProcess server(flags());
    RawClient viewer(server.port());
    const Json welcome = viewer.hello({{"resume", {{"session", "s"}, {"state", {{"scene", scene_}}}}}});
    EXPECT_EQ(welcome["missing_assets"], Json::array({sha256(file_)}));
    EXPECT_EQ(viewer.update({{"scene", scene_}})["code"], "asset_missing");
}

TEST_F(SharedFolder, AFileThatLiesIsMissingAndCanBeUploadedAgain) {
    std::ofstream(pathOf(file_)) << "no such thing";
    ServerProcess server(flags());
    RawClient viewer(server.port());
    viewer.hello();
    EXPECT_EQ(viewer.update({{"scene", scene_}})["code"], "asset_missing");
    EXPECT_EQ(upload(viewer, file_)["op"], "ok");
    EXPECT_EQ(viewer.update({{"scene", scene_}})["op"], "ok");
}

TEST_F(SharedFolder, WhatIsNoSceneIsNotKept) {
    ServerProcess server(flags());
    RawClient viewer(server.port());
    viewer.hello();
    EXPECT_EQ(upload(viewer, "no scene at all")["code"], "asset_invalid");
    EXPECT_TRUE(fs::is_empty(folder_));
}

TEST(AssetDirFlag, AFolderThatCannotBeMadeIsOneLine) {
    const Ended ended = runServer({"--port", "0", "--asset-dir", "/proc/none"});
    EXPECT_EQ(ended.exitCode, 1);
    EXPECT_THAT(ended.err, HasSubstr("asset directory; cannot write to /proc/none"));
}

int glObjects(int port) {
    constexpr std::string_view kName = "\ncaustream_gl_objects ";
    const std::string metrics = httpGet(port, "/metrics");
    const std::size_t at = metrics.find(kName);
    return at == std::string::npos ? -1 : std::stoi(metrics.substr(at + kName.size()));
}

// The scene itself is kept in memory, as the budget allows.
TEST(GpuCopies, GoWithTheLastWhoShowsThem) {
    ServerProcess server;
    RawClient staying(server.port());
    staying.hello();
    staying.update(kSmall);
    staying.update({{"scene", {"builtin", "prism"}}});
    staying.requestFrame();
    const int before = glObjects(server.port());
    ASSERT_GT(before, 0);
    {
        RawClient leaving(server.port());
        leaving.hello();
        leaving.update(kSmall);
        ASSERT_EQ(leaving.update({{"scene", {"builtin", "sphere"}}})["op"], "ok");
        leaving.requestFrame();
        EXPECT_GT(glObjects(server.port()), before);
    }
    int after = 0;
    for (int tries = 0; tries < 100 && (after = glObjects(server.port())) > before; ++tries) {
        usleep(100'000);
    }
    EXPECT_LE(after, before);
    staying.requestFrame();
    EXPECT_LE(glObjects(server.port()), before) << "and what is shown is drawn from what there was";
}

class LongLoad : public testing::Test {
   protected:
    LongLoad() { viewer_.hello(); }

    ServerProcess server_;
    RawClient viewer_{server_.port()};
    const std::string file_ = bumpyGlass(600);  // 720 thousand triangles, 13 MB
};

TEST_F(LongLoad, TellsHowFarItIsAndThatItEnds) {
    const Json offer = beginUpload(viewer_, file_, sha256(file_));
    sendChunks(viewer_, file_, offer);
    viewer_.json({{"op", "asset.end"}, {"id", 900}, {"asset", offer["asset"]}});
    std::vector<std::string> said;
    for (Json reply; reply["op"] != "ok";) {
        const Message message = viewer_.next();
        ASSERT_EQ(message.kind, Message::Kind::Text);
        reply = Json::parse(message.text);
        ASSERT_NE(reply["op"], "error") << reply;
        if (reply["op"] == "status" && reply["key"] == "load") {
            said.push_back(reply["message"]);
        }
    }
    ASSERT_GE(said.size(), 2u);
    EXPECT_EQ(said.back(), "") << "before the reply";
    said.pop_back();
    for (const std::string& message : said) {
        EXPECT_THAT(message, testing::MatchesRegex("reading the file: [0-9]+%"));
    }
}

TEST_F(LongLoad, AbortEndsTheReading) {
    const Json offer = beginUpload(viewer_, file_, sha256(file_));
    sendChunks(viewer_, file_, offer);
    viewer_.json({{"op", "asset.end"}, {"id", 900}, {"asset", offer["asset"]}});
    viewer_.json({{"op", "asset.abort"}, {"asset", offer["asset"]}});
    const auto error = viewer_.textOf("error");
    ASSERT_TRUE(error);
    EXPECT_EQ((*error)["id"], 900) << *error;
    EXPECT_EQ((*error)["code"], "asset_missing");
    EXPECT_EQ(viewer_.update({{"scene", {"asset", sha256(file_)}}})["code"], "asset_missing");
    EXPECT_EQ(upload(viewer_, builtinGlb("prism"))["op"], "ok");
}

TEST_F(LongLoad, OthersAreNotHeldUp) {
    const Json offer = beginUpload(viewer_, file_, sha256(file_));
    sendChunks(viewer_, file_, offer);
    viewer_.json({{"op", "asset.end"}, {"id", 900}, {"asset", offer["asset"]}});
    RawClient other(server_.port());
    other.hello();
    EXPECT_EQ(other.update({{"scene", {"builtin", "prism"}}})["op"], "ok");
    while (viewer_.next().text.find("\"id\":900") == std::string::npos) {
    }
}

TEST_F(LongLoad, WhoLeavesTakesItsReadingAlong) {
    {
        RawClient leaving(server_.port());
        leaving.hello();
        const Json offer = beginUpload(leaving, file_, sha256(file_));
        sendChunks(leaving, file_, offer);
        leaving.json({{"op", "asset.end"}, {"id", 900}, {"asset", offer["asset"]}});
        leaving.json({{"op", "ping"}, {"t_us", 1}});
        EXPECT_TRUE(leaving.textOf("pong"));
    }
    EXPECT_EQ(viewer_.update({{"scene", {"builtin", "prism"}}})["op"], "ok");
    EXPECT_EQ(viewer_.update({{"scene", {"asset", sha256(file_)}}})["code"], "asset_missing");
    EXPECT_EQ(server_.stop().exitCode, 0) << "and the server does not wait for it";
}

}  // namespace
}  // namespace caustream::e2e
