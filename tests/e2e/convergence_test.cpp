// A picture that rests: it comes nearer frame by frame, says so, and ends with one frame that says it is there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "raw_client.h"
#include "server_process.h"

namespace caustream::e2e {
namespace {

constexpr std::uint32_t kLast = protocol::kFrameStill | protocol::kFrameConverged;
constexpr int kSilenceMs = 700;  // longer than the server waits before anything that it does by itself

// A few frames to go: a small map, and an error that one frame's photons do not reach.
const Json kTraced = {{"transport", {{"mode", "traced"}, {"map_size", 256}, {"budget_ms", 5}, {"target_error", 0.015}}},
                      {"stream", {{"width", 96}, {"height", 64}, {"max_fps", 240}}}};

Json moved(double x) { return {{"lights", {{"key", {{"position", {x, 1.9, -0.6}}}}}}}; }

class Convergence : public testing::Test {
   protected:
    // Frames until the last of a state that has converged, or until nothing comes; each acknowledged.
    static std::vector<protocol::FrameHeader> untilConverged(RawClient& viewer, std::size_t most = 5000) {
        std::vector<protocol::FrameHeader> headers;
        while (headers.size() < most && (headers.empty() || !(headers.back().flags & protocol::kFrameConverged))) {
            const auto picture = viewer.frame(20'000);
            if (!picture) {
                break;
            }
            headers.push_back(picture->header);
            viewer.ack(picture->header.frameSeq);
        }
        return headers;
    }
    static void start(RawClient& viewer, const Json& patch = Json::object()) {
        viewer.hello({{"caps", {"jpeg", "png", "raw", "f16"}}});
        viewer.update(kTraced);
        if (!patch.empty()) {
            ASSERT_EQ(viewer.update(patch)["op"], "ok") << patch;
        }
        viewer.ask({{"op", "stream.start"}, {"stats", true}});
    }

    ServerProcess server_;
};

TEST_F(Convergence, ComesNearerAndEndsWithOneLosslessStill) {
    RawClient viewer(server_.port());
    start(viewer);
    const auto headers = untilConverged(viewer);
    ASSERT_GT(headers.size(), 3u) << "it converges in more than a frame";
    for (std::size_t i = 0; i + 1 < headers.size(); ++i) {
        EXPECT_EQ(headers[i].flags, 0u) << i;
        EXPECT_EQ(headers[i].encoding, protocol::Encoding::Jpeg);
        EXPECT_EQ(headers[i].stateRev, headers.back().stateRev);
    }
    EXPECT_EQ(headers.back().flags, kLast);
    EXPECT_EQ(headers.back().encoding, protocol::Encoding::Png) << "without JPEG's losses";
    ASSERT_EQ(viewer.infos.size(), 2u) << "another encoding is another epoch";
    EXPECT_EQ(viewer.infos[1]["encoding"], "png");
    EXPECT_FALSE(viewer.frame(kSilenceMs)) << "and then nothing";

    // Every few statistics tell how far it is, those of the last frame that it is there.
    std::vector<Json> steps;
    for (const Json& stats : viewer.stats) {
        ASSERT_TRUE(stats.contains("convergence")) << stats;
        steps.push_back(stats["convergence"]);
    }
    ASSERT_GE(steps.size(), 2u);
    for (std::size_t i = 1; i < steps.size(); ++i) {
        EXPECT_GE(steps[i]["photons"], steps[i - 1]["photons"]);
        EXPECT_GE(steps[i]["progress"], steps[i - 1]["progress"]);
    }
    EXPECT_LT(steps.front()["photons"], steps.back()["photons"]);
    EXPECT_GT(steps.front()["error"], steps.back()["error"]);
    EXPECT_LE(steps.back()["error"], steps.back()["target"]);
    EXPECT_DOUBLE_EQ(steps.back()["target"], 0.015);
    EXPECT_EQ(steps.back()["converged"], true);
    EXPECT_EQ(viewer.stats.back()["frame_seq"], headers.back().frameSeq);
    EXPECT_FALSE(steps.front()["converged"]);
}

TEST_F(Convergence, InputStartsItAnew) {
    RawClient viewer(server_.port());
    start(viewer);
    const auto before = untilConverged(viewer, 3);
    ASSERT_EQ(before.size(), 3u);
    viewer.stats.clear();
    const std::uint32_t rev = viewer.update(moved(0.4))["rev"];
    auto headers = untilConverged(viewer);
    std::erase_if(headers, [&](const protocol::FrameHeader& header) { return header.stateRev != rev; });
    ASSERT_GT(headers.size(), 3u);
    EXPECT_EQ(headers.back().flags, kLast);
    EXPECT_EQ(std::ranges::count_if(headers, [](const auto& header) { return header.flags != 0; }), 1);
    EXPECT_FALSE(viewer.frame(kSilenceMs));

    // A camera that moves keeps the light's photons: nothing but its picture is to do again.
    const Json photons = viewer.stats.back()["convergence"]["photons"];
    viewer.update({{"camera", {{"fov_y_deg", 41}}}});
    const auto camera = untilConverged(viewer);
    ASSERT_FALSE(camera.empty());
    EXPECT_EQ(camera.back().flags, kLast);
    EXPECT_EQ(viewer.stats.back()["convergence"]["photons"], photons);
}

TEST_F(Convergence, TheSpectralMapsLastFrameIsFlagged) {
    RawClient viewer(server_.port());
    start(viewer, {{"stream", {{"target", "spectral"}, {"encoding", "raw"}, {"sample", "f16"}}}});
    const auto headers = untilConverged(viewer);
    ASSERT_GT(headers.size(), 2u);
    EXPECT_EQ(headers.back().flags, kLast);
    EXPECT_EQ(headers.back().rawLen, 256u * 256 * 3 * 2);
    EXPECT_EQ(viewer.infos.size(), 1u) << "the samples are as ever";
    EXPECT_FALSE(viewer.frame(kSilenceMs));
}

TEST_F(Convergence, WhoeverReadsNoPngGetsNone) {
    RawClient viewer(server_.port());
    viewer.hello({{"caps", {"jpeg"}}});
    viewer.update(kTraced);
    viewer.ask({{"op", "stream.start"}});
    const auto headers = untilConverged(viewer);
    ASSERT_FALSE(headers.empty());
    EXPECT_EQ(headers.back().flags, kLast);
    EXPECT_EQ(headers.back().encoding, protocol::Encoding::Jpeg);
}

TEST_F(Convergence, ARequestedFrameSaysWhetherItHasConverged) {
    RawClient viewer(server_.port());
    start(viewer);
    viewer.ask({{"op", "stream.pause"}});
    while (viewer.frame(kSilenceMs)) {
    }
    EXPECT_EQ(viewer.requestFrame(true).header.flags, protocol::kFrameStill + 0u);
    viewer.ask({{"op", "stream.resume"}});
    EXPECT_EQ(untilConverged(viewer).back().flags, kLast);
    EXPECT_EQ(viewer.requestFrame(true, true).header.flags, kLast);
}

TEST_F(Convergence, TwoAtRestBothConverge) {
    RawClient one(server_.port()), other(server_.port());
    start(one);
    start(other, moved(0.3));
    EXPECT_EQ(untilConverged(one).back().flags, kLast);
    EXPECT_EQ(untilConverged(other).back().flags, kLast);
}

TEST_F(Convergence, AMeshIsRefinedWhileItMovesAndTracedAtRest) {
    RawClient viewer(server_.port());
    start(viewer, {{"scene", {"builtin", "sphere"}}, {"transport", {{"mode", "auto"}}}});
    const auto headers = untilConverged(viewer);
    ASSERT_GT(headers.size(), 2u);
    EXPECT_EQ(headers.back().flags, kLast);
    EXPECT_FALSE(viewer.frame(kSilenceMs));
}

TEST_F(Convergence, WhatDoesNotConvergeEndsWithOneStillAndOnceMoreWithoutLoss) {
    RawClient viewer(server_.port());
    start(viewer, {{"transport", {{"mode", "refined"}, {"budget_ms", 0}, {"target_error", 0}}}});
    std::vector<std::pair<std::uint32_t, protocol::Encoding>> frames;
    while (const auto picture = viewer.frame(1500)) {
        frames.emplace_back(picture->header.flags, picture->header.encoding);
        viewer.ack(picture->header.frameSeq);
    }
    using protocol::Encoding;
    EXPECT_THAT(frames, testing::ElementsAre(std::pair(0u, Encoding::Jpeg), std::pair(protocol::kFrameStill + 0u, Encoding::Jpeg),
                                             std::pair(protocol::kFrameStill + 0u, Encoding::Png)));
    for (const Json& stats : viewer.stats) {
        EXPECT_FALSE(stats.contains("convergence"));
    }
}

}  // namespace
}  // namespace caustream::e2e
