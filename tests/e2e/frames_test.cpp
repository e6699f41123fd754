// What a viewer sees: pictures and maps of the scene it asked for, when it asked, and no more than it can take.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "raw_client.h"
#include "server_process.h"

namespace caustream::e2e {
namespace {

// Small pictures and few photons, in one frame: the tests look at the protocol, not at the light.
const Json kSmall = {{"transport", {{"mode", "refined"}, {"photon_grid", 64}, {"map_size", 64}}},
                     {"stream", {{"width", 96}, {"height", 64}, {"max_fps", 240}}}};

Json moved(double x) { return {{"lights", {{"key", {{"position", {x, 4.0, 0.5}}, {"direction", {-x, -4.0, -0.5}}}}}}}; }

double mean(const std::vector<std::uint8_t>& samples) {
    return std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
}

double difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += std::abs(static_cast<double>(a[i]) - b[i]);
    }
    return sum / static_cast<double>(a.size());
}

class Frames : public testing::Test {
   protected:
    ServerProcess server_;
};

TEST_F(Frames, WelcomeTellsWhatThereIs) {
    RawClient viewer(server_.port());
    const Json welcome = viewer.hello();
    EXPECT_EQ(welcome["protocol"], "caustream.v1");
    EXPECT_THAT(welcome["scenes"], testing::Contains("sphere"));
    EXPECT_THAT(welcome["passes"], testing::Contains("map_resolve"));
    EXPECT_FALSE(welcome["gpu"].get<std::string>().empty());
    EXPECT_EQ(welcome["limits"]["sessions"], 8);
}

TEST_F(Frames, CompositeArrivesAsAJpegWithAPictureInIt) {
    RawClient viewer(server_.port());
    viewer.hello();
    viewer.update(kSmall);
    const Picture picture = viewer.requestFrame(true);
    EXPECT_EQ(picture.header.encoding, protocol::Encoding::Jpeg);
    EXPECT_EQ(picture.header.width, 96);
    EXPECT_EQ(picture.header.height, 64);
    EXPECT_TRUE(picture.header.flags & protocol::kFrameStill);
    EXPECT_EQ(viewer.lastReply["frame_seq"], picture.header.frameSeq);
    EXPECT_EQ(viewer.lastReply["map_hash"].get<std::string>().size(), 16u);
    ASSERT_EQ(viewer.infos.size(), 1u);
    EXPECT_EQ(viewer.infos[0]["target"], "composite");

    const std::vector<std::uint8_t> rgb = decodeJpeg(picture);
    ASSERT_EQ(rgb.size(), 96u * 64 * 3);
    EXPECT_GT(mean(rgb), 5.0) << "a lit scene is not black";
    EXPECT_LT(mean(rgb), 250.0) << "nor all white";
    const auto [low, high] = std::ranges::minmax(rgb);
    EXPECT_GT(high - low, 60) << "there is something to see in it";
}

TEST_F(Frames, StatisticsEstimateTheErrorAndSayWhatABudgetChose) {
    RawClient viewer(server_.port());
    viewer.hello();
    viewer.update(kSmall);
    viewer.json({{"op", "frame.request"}, {"id", 1000}});
    const auto plain = viewer.textOf("stats");
    ASSERT_TRUE(plain && plain->contains("error"));
    EXPECT_GT((*plain)["error"]["sampling"], 0.0);
    EXPECT_GE((*plain)["error"]["total"], (*plain)["error"]["sampling"]);
    EXPECT_TRUE(!plain->contains("choice") || (*plain)["choice"] == "");

    viewer.update({{"transport", {{"budget_ms", 1}}}});
    viewer.json({{"op", "frame.request"}, {"id", 1001}});
    const auto hurried = viewer.textOf("stats");
    ASSERT_TRUE(hurried && hurried->contains("choice"));
    EXPECT_THAT((*hurried)["choice"].get<std::string>(), testing::HasSubstr("nothing keeps within 1 ms"));

    viewer.update({{"transport", {{"budget_ms", 0}, {"target_error", 0.5}}}});
    viewer.json({{"op", "frame.request"}, {"id", 1002}});
    const auto patient = viewer.textOf("stats");
    ASSERT_TRUE(patient && patient->contains("choice"));
    EXPECT_THAT((*patient)["choice"].get<std::string>(), testing::HasSubstr("the fastest that reaches 50%"));
}

TEST_F(Frames, SameStateGivesTheSameHash) {
    RawClient viewer(server_.port());
    viewer.hello();
    viewer.update(kSmall);
    viewer.requestFrame(true);
    const std::string first = viewer.lastReply["map_hash"];
    viewer.update(moved(0.3));
    viewer.requestFrame(true);
    EXPECT_NE(viewer.lastReply["map_hash"], first);
    viewer.update({{"lights", nullptr}});
    viewer.requestFrame(true);
    EXPECT_EQ(viewer.lastReply["map_hash"], first);
}

TEST_F(Frames, SpectralMapArrivesAsFloats) {
    RawClient viewer(server_.port());
    viewer.hello();
    viewer.update(kSmall);
    const Json reply =
        viewer.update({{"stream", {{"target", "spectral"}, {"encoding", "raw"}, {"sample", "f32"}, {"bands", "wavelengths"}}},
                       {"transport", {{"wavelengths", 5}}}});
    ASSERT_EQ(reply["op"], "ok") << reply;
    const Picture picture = viewer.requestFrame();
    EXPECT_EQ(picture.header.target, protocol::Target::Spectral);
    EXPECT_EQ(picture.header.bands, 5);
    ASSERT_EQ(picture.payload.size(), 64u * 64 * 5 * 4);
    ASSERT_EQ(viewer.infos.size(), 1u);
    EXPECT_EQ(viewer.infos[0]["wavelengths_nm"].size(), 5u);
    EXPECT_EQ(viewer.infos[0]["unit"], "concentration");

    std::vector<float> samples(picture.payload.size() / 4);
    std::memcpy(samples.data(), picture.payload.data(), picture.payload.size());
    EXPECT_TRUE(std::ranges::all_of(samples, [](float v) { return std::isfinite(v) && v >= 0.0f; }));
    EXPECT_GT(*std::ranges::max_element(samples), 0.1f) << "light came through";
}

TEST_F(Frames, ZstdIsRawInFewerBytes) {
    RawClient viewer(server_.port());
    const Json welcome = viewer.hello({{"caps", {"raw", "zstd", "shuffle", "f16"}}});
    EXPECT_THAT(welcome["caps"], testing::IsSupersetOf({"zstd", "shuffle"}));
    viewer.update(kSmall);
    viewer.update({{"stream", {{"target", "spectral"}, {"encoding", "raw"}, {"sample", "f16"}}}});
    const Picture raw = viewer.requestFrame();
    ASSERT_EQ(viewer.update({{"stream", {{"encoding", "zstd"}}}})["op"], "ok");
    const Picture packed = viewer.requestFrame();
    EXPECT_EQ(packed.header.encoding, protocol::Encoding::Zstd);
    EXPECT_EQ(packed.header.layout, protocol::Layout::PlanarShuffle);
    EXPECT_EQ(viewer.infos.back()["layout"], "planar+shuffle");
    EXPECT_LT(packed.payload.size(), raw.payload.size());
    std::vector<std::uint8_t> shuffled(packed.header.rawLen);
    ASSERT_EQ(ZSTD_decompress(shuffled.data(), shuffled.size(), packed.payload.data(), packed.payload.size()), raw.payload.size());
    const std::size_t samples = raw.payload.size() / 2, texels = samples / 3;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < raw.payload.size(); ++i) {
        const std::size_t byte = i % 2, band = i / 2 % 3, texel = i / 6;
        wrong += raw.payload[i] != shuffled[byte * samples + band * texels + texel];
    }
    EXPECT_EQ(wrong, 0u);
}

TEST_F(Frames, AMovedLightBeginsANewEpochOfTheMap) {
    RawClient viewer(server_.port());
    viewer.hello();
    viewer.update(kSmall);
    viewer.update({{"stream", {{"target", "spectral"}, {"encoding", "raw"}, {"sample", "f16"}}}});
    const Picture before = viewer.requestFrame();
    viewer.update({{"camera", {{"fov_y_deg", 33}}}});
    EXPECT_EQ(viewer.requestFrame().header.epoch, before.header.epoch) << "the camera does not move the map";
    viewer.update(moved(0.4));
    EXPECT_EQ(viewer.requestFrame().header.epoch, before.header.epoch + 1);
    ASSERT_EQ(viewer.infos.size(), 2u);
    EXPECT_NE(viewer.infos[0]["light_matrix"], viewer.infos[1]["light_matrix"]);
}

TEST_F(Frames, EveryPassCanBeLookedAt) {
    RawClient viewer(server_.port());
    const Json welcome = viewer.hello();
    viewer.update(kSmall);
    for (const auto& pass : welcome["passes"]) {
        ASSERT_EQ(viewer.update({{"stream", {{"target", pass}, {"encoding", "raw"}}}})["op"], "ok") << pass;
        const Picture picture = viewer.requestFrame();
        EXPECT_EQ(picture.header.target, protocol::Target::Pass) << pass;
        EXPECT_EQ(picture.payload.size(), std::size_t{picture.header.width} * picture.header.height * 3) << pass;
    }
}

TEST_F(Frames, InputComesBackInTheHeaderOfTheFrameThatShowsIt) {
    RawClient viewer(server_.port());
    viewer.hello();
    viewer.update(kSmall);
    viewer.ask({{"op", "stream.start"}});
    auto picture = viewer.frame();
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->header.inputSeq, 0u);
    viewer.ack(picture->header.frameSeq);
    Json input = moved(0.2);
    input.update({{"op", "input"}, {"seq", 7}, {"t_us", 123456}});
    viewer.json(input);
    do {
        picture = viewer.frame();
        ASSERT_TRUE(picture);
        viewer.ack(picture->header.frameSeq);
    } while (picture->header.inputSeq == 0);
    EXPECT_EQ(picture->header.inputSeq, 7u);
    EXPECT_EQ(picture->header.clientUs, 123456u);
}

TEST_F(Frames, WithoutAcknowledgementsTwoFramesLeave) {
    RawClient viewer(server_.port());
    viewer.hello({{"max_inflight", 8}});
    viewer.update(kSmall);
    viewer.ask({{"op", "stream.start"}});
    int frames = 0;
    std::uint32_t newest = 0;
    for (int i = 1; i <= 12; ++i) {
        viewer.update(moved(0.02 * i));
        if (const auto picture = viewer.frame(100)) {
            ++frames;
            newest = picture->header.frameSeq;
        }
    }
    while (viewer.frame(700)) {
        ++frames;
    }
    EXPECT_EQ(frames, 2);
    viewer.ack(newest);
    EXPECT_TRUE(viewer.frame()) << "an acknowledgement opens the window again";
}

TEST_F(Frames, WhereNothingChangesOneStillIsTheLast) {
    RawClient viewer(server_.port());
    viewer.hello();
    viewer.update(kSmall);
    viewer.ask({{"op", "stream.start"}});
    std::vector<std::uint32_t> flags;
    while (const auto picture = viewer.frame(1500)) {
        flags.push_back(picture->header.flags & protocol::kFrameStill);
        viewer.ack(picture->header.frameSeq);
    }
    EXPECT_THAT(flags, testing::ElementsAre(0u, protocol::kFrameStill + 0u));
    // A pause, and a change meanwhile: nothing comes until the stream goes on.
    viewer.ask({{"op", "stream.pause"}});
    viewer.update(moved(0.3));
    EXPECT_FALSE(viewer.frame(700));
    viewer.ask({{"op", "stream.resume"}});
    EXPECT_TRUE(viewer.frame());
}

TEST_F(Frames, TwoViewersSeeTheirOwnScenes) {
    RawClient one(server_.port()), other(server_.port());
    for (RawClient* viewer : {&one, &other}) {
        viewer->hello();
        viewer->update(kSmall);
        viewer->update({{"stream", {{"encoding", "raw"}}}});
    }
    one.update({{"scene", {"builtin", "sphere"}}});
    other.update({{"scene", {"builtin", "gem"}}});
    const Picture sphere = one.requestFrame();
    const Picture gem = other.requestFrame();
    EXPECT_GT(difference(sphere.payload, gem.payload), 1.0);
    other.update({{"camera", {{"fov_y_deg", 70}}}});
    other.requestFrame();
    EXPECT_EQ(difference(one.requestFrame().payload, sphere.payload), 0.0) << "another's camera is not mine";
}

TEST_F(Frames, StatisticsComeWhenAskedFor) {
    RawClient viewer(server_.port());
    viewer.hello();
    viewer.update(kSmall);
    viewer.ask({{"op", "stream.start"}, {"stats", true}});
    const auto stats = viewer.textOf("stats", 10'000);
    ASSERT_TRUE(stats);
    EXPECT_FALSE((*stats)["plan"].empty());
    EXPECT_FALSE((*stats)["stages"].empty());
    EXPECT_GT((*stats)["photons"], 0);
}

TEST_F(Frames, AClientThatComesBackBringsItsDocument) {
    Json document;
    {
        RawClient viewer(server_.port());
        viewer.hello();
        viewer.update({{"scene", {"builtin", "sphere"}}, {"camera", {{"fov_y_deg", 55}}}});
        document = {{"scene", {"builtin", "sphere"}}, {"camera", {{"fov_y_deg", 55}}}};
    }
    RawClient viewer(server_.port());
    const Json welcome = viewer.hello({{"resume", {{"session", "gone"}, {"state", document}}}});
    EXPECT_EQ(welcome["state"]["camera"]["fov_y_deg"], 55);
    EXPECT_EQ(welcome["state"]["scene"], Json({"builtin", "sphere"}));

    RawClient lost(server_.port());
    const std::string sha256(64, 'a');
    const Json other = lost.hello({{"resume", {{"session", "gone"}, {"state", {{"scene", {"asset", sha256}}}}}}});
    EXPECT_THAT(other["missing_assets"], testing::ElementsAre(sha256));
}

}  // namespace
}  // namespace caustream::e2e
