// caustream-view under Xvfb, with a real mouse: what is on the screen, and where the caustic goes when the light is
// dragged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "client/connection/connection.h"
#include "display.h"

namespace caustream::e2e {
namespace {

using namespace std::chrono_literals;

constexpr int kWidth = 960, kHeight = 600;
constexpr int kPictureWidth = kWidth - 350;  // the panel has the rest

Pixels pictureOf(const Pixels& screen) {
    Pixels out{kPictureWidth, screen.height, 3, {}};
    for (int y = 0; y < screen.height; ++y) {
        const auto* row = &screen.values[static_cast<std::size_t>(3 * y * screen.width)];
        out.values.insert(out.values.end(), row, row + 3 * kPictureWidth);
    }
    return out;
}

double difference(const Pixels& a, const Pixels& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.values.size(); ++i) sum += std::abs(a.values[i] - b.values[i]);
    return sum / static_cast<double>(a.values.size());
}

// The caustic: nothing in the sphere's room is as bright.
Centroid causticOf(const Pixels& picture) {
    return centroidAbove(picture, picture.quantile(0.998) - 0.5);
}

class View : public testing::Test {
 protected:
    // The picture once it has stood still for a second, and fits; the last one after a minute and a half.
    template <class Fits>
    Pixels settled(const Fits& fits) {
        Pixels before = pictureOf(display_.look());
        int still = 0;
        for (int i = 0; i < 180 && still < 3; ++i) {
            std::this_thread::sleep_for(500ms);
            Pixels now = pictureOf(display_.look());
            still = difference(before, now) < 0.05 && fits(now) ? still + 1 : 0;
            before = std::move(now);
        }
        return before;
    }
    static bool isLit(const Pixels& picture) { return picture.quantile(0.998) > 180.0 && picture.quantile(0.3) > 5.0; }

    std::unique_ptr<Server> server_ = std::make_unique<Server>();
    Display display_{kWidth, kHeight};
    TemporaryFolder folder_;
    Background open(const std::string& scene, const std::vector<std::string>& settings) {
        return open({"--scene", scene}, settings);
    }
    Background open(std::vector<std::string> what, const std::vector<std::string>& settings) {
        std::vector<std::string> arguments = {"--url", server_->url(), "--save-folder", folder_.path, "--width",
                                              std::to_string(kWidth), "--height", std::to_string(kHeight)};
        arguments.insert(arguments.end(), what.begin(), what.end());
        for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
        return {CAUSTREAM_BIN "/caustream-view", arguments, display_.environment()};
    }
};

// How far the thin bar at the picture's lower edge goes, 0..1; -1: there is none.
double progressOf(const Pixels& picture) {
    const auto* row = &picture.values[static_cast<std::size_t>(3 * (picture.height - 1) * picture.width)];
    const auto isBar = [&](int x) {
        return std::abs(row[3 * x] - 255) < 40 && std::abs(row[3 * x + 1] - 181) < 40 && row[3 * x + 2] < 130;
    };
    int length = 0;
    while (length < picture.width && isBar(length)) ++length;
    return length > 0 ? static_cast<double>(length) / picture.width : -1.0;
}

TEST_F(View, ADraggedLightMovesTheCausticTheOtherWay) {
    const Background view = open("sphere", {"transport.mode=refined"});
    const Pixels first = settled(isLit);
    ASSERT_TRUE(isLit(first)) << "no picture came";
    const Centroid start = causticOf(first);

    // The light goes right, what the sphere gathers goes left.
    display_.drag(kPictureWidth / 2, kHeight / 2, 70, 0, "shift");
    const Pixels second = settled([&](const Pixels& picture) { return difference(picture, first) > 0.5; });
    const Centroid moved = causticOf(second);
    EXPECT_LT(moved.x, start.x - 12.0);

    // S saves the picture that is on the screen: the same light, without JPEG and the screen's scaling.
    display_.hand({"key", "s"});
    const std::string saved = folder_ / "caustream-sphere-1.png";
    for (int i = 0; i < 120 && !std::filesystem::exists(saved); ++i) std::this_thread::sleep_for(500ms);
    std::this_thread::sleep_for(500ms);
    const Pixels file = readPng(saved);
    const Centroid inFile = causticOf(file);
    EXPECT_NEAR(inFile.x / file.width, moved.x / kPictureWidth, 0.04);
    EXPECT_NEAR(inFile.y / file.height, moved.y / kHeight, 0.04);

    // And back; then the camera: what stood in the middle still does, what lay off it went aside.
    display_.drag(kPictureWidth / 2, kHeight / 2, -70, 0, "shift");
    const Pixels third = settled([&](const Pixels& picture) { return difference(picture, second) > 0.5; });
    EXPECT_NEAR(causticOf(third).x, start.x, 12.0);

    display_.drag(kPictureWidth / 2, kHeight / 2, 0, 60);
    const Pixels orbited = settled([&](const Pixels& picture) { return difference(picture, third) > 1.0; });
    EXPECT_GT(difference(orbited, third), 1.0);
}

TEST_F(View, ABarGrowsWhileThePictureConvergesAndGoesWhenItHas) {
    const Background view = open("gem", {"transport.mode=traced", "transport.target_error=0.012", "transport.map_size=256"});
    double first = -1.0, longest = -1.0;
    bool gone = false;
    for (int i = 0; i < 900 && !gone; ++i) {
        std::this_thread::sleep_for(100ms);
        const double now = progressOf(pictureOf(display_.look()));
        if (first < 0.0) first = now;
        longest = std::max(longest, now);
        gone = longest > 0.0 && now < 0.0;
    }
    EXPECT_GT(first, 0.0) << "there was no bar";
    EXPECT_GT(longest, first) << "it did not grow";
    EXPECT_TRUE(gone) << "it stayed";
}

TEST_F(View, ShowsItsOwnPoseAgainAfterItsServerWasKilled) {
    const Background view = open("sphere", {"transport.mode=refined"});
    const Pixels first = settled(isLit);
    ASSERT_TRUE(isLit(first)) << "no picture came";
    display_.drag(kPictureWidth / 2, kHeight / 2, 70, 0, "shift");
    const Pixels moved = settled([&](const Pixels& picture) { return difference(picture, first) > 0.5; });

    const std::string port = server_->port();
    server_->kill();
    std::this_thread::sleep_for(500ms);
    // The picture stays, but for the note at its top.
    const Pixels without = pictureOf(display_.look());
    EXPECT_GT(difference(without, moved), 0.05) << "nothing says that the server is gone";
    EXPECT_LT(difference(without, moved), 3.0) << "the picture is gone";
    // And what is done meanwhile is not lost.
    display_.drag(kPictureWidth / 2, kHeight / 2, 60, 0);
    server_ = std::make_unique<Server>(std::vector<std::string>{"--port", port});
    const Pixels turned = settled([&](const Pixels& picture) { return difference(picture, moved) > 3.0; });
    EXPECT_GT(difference(turned, moved), 3.0) << "what was done meanwhile is not to be seen";
    display_.drag(kPictureWidth / 2, kHeight / 2, -60, 0);
    const Pixels back = settled([&](const Pixels& picture) { return difference(picture, turned) > 3.0; });
    EXPECT_LT(difference(back, moved), 0.5) << "it is another picture";
}

TEST_F(View, FollowsAnothersLight) {
    connection::Connection leader({.address = *connection::parseAddress(server_->url()), .clientName = "view_test"});
    ASSERT_TRUE(leader.update({{"scene", {"builtin", "sphere"}}, {"transport", {{"mode", "refined"}}}}));
    std::string viewId;
    protocol::Json light;
    for (int i = 0; i < 600 && light.is_null(); ++i, leader.wait(100ms))
        for (const auto& event : leader.takeEvents()) {
            if (const auto* welcome = std::get_if<protocol::Welcome>(&event)) viewId = welcome->viewId;
            if (const auto* state = std::get_if<protocol::StateMessage>(&event))
                if (state->scene.name == "sphere") light = state->state["lights"]["key"];
        }
    ASSERT_FALSE(light.is_null());

    const Background view = open({"--follow", viewId}, {});
    const Pixels first = settled(isLit);
    ASSERT_TRUE(isLit(first)) << "no picture came";
    // Its own hand moves its camera, and not the light.
    display_.drag(kPictureWidth / 2, kHeight / 2, 0, 40, "shift");
    const Pixels turned = settled([&](const Pixels& picture) { return difference(picture, first) > 1.0; });
    EXPECT_GT(difference(turned, first), 1.0);
    for (const char* of : {"position", "direction"}) light[of][0] = -light[of][0].get<double>();
    ASSERT_TRUE(leader.input({{"lights", {{"key", {{"position", light["position"]}, {"direction", light["direction"]}}}}}}));
    const Pixels lit = settled([&](const Pixels& picture) { return difference(picture, turned) > 0.5; });
    EXPECT_GT(causticOf(lit).x, causticOf(turned).x + 12.0) << "the light went to the left, the caustic goes to the right";
}

TEST_F(View, StaysSmallAndEndsWhenAsked) {
    Background view = open("sphere", {"transport.mode=refined"});
    ASSERT_TRUE(isLit(settled(isLit))) << "no picture came";
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    std::ifstream status("/proc/" + std::to_string(view.pid()) + "/status");
    std::stringstream text;
    text << status.rdbuf();
    const auto at = text.str().find("VmRSS:");
    ASSERT_NE(at, std::string::npos);
    EXPECT_LT(std::stoi(text.str().substr(at + 6)), 150 * 1024) << "kB resident";
#endif
    display_.hand({"mousemove", "200", "200"});
    display_.hand({"key", "Escape"});
    EXPECT_TRUE(view.ends());
}

TEST(ViewArguments, AreCheckedInOneLine) {
    const auto expectOneLine = [](const Result& result, const std::string& part) {
        EXPECT_EQ(result.exitCode, 1);
        EXPECT_THAT(result.err, testing::StartsWith("caustream-view: "));
        EXPECT_THAT(result.err, testing::HasSubstr(part));
        EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    };
    const std::string view = CAUSTREAM_BIN "/caustream-view";
    expectOneLine(run(view, {"--url", "nonsense://"}), "http://host:port");
    expectOneLine(run(view, {"missing.glb"}), "missing.glb");
    expectOneLine(run(view, {"--no-such-option"}), "--no-such-option");
    expectOneLine(run(view, {}, {{"DISPLAY", ":65000"}, {"WAYLAND_DISPLAY", ""}}), "display");
    EXPECT_EQ(run(view, {"--help"}).exitCode, 0);
}

}  // namespace
}  // namespace caustream::e2e
