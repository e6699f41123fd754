// Three servers behind HAProxy, as deploy/haproxy.cfg has it, and twelve viewers. One server is killed, one frozen, one drained:
// every viewer goes on elsewhere, with its own scene and pose.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <functional>
#include <memory>

#include "../server_process.h"
#include "lasting_viewer.h"
#include "load_balancer.h"

namespace caustream::e2e {
namespace {

using namespace std::chrono_literals;

constexpr int kViewers = 12;

bool eventually(const std::function<bool()>& condition, std::chrono::seconds most) {
    for (const auto last = std::chrono::steady_clock::now() + most; std::chrono::steady_clock::now() < last;) {
        if (condition()) {
            return true;
        }
        std::this_thread::sleep_for(50ms);
    }
    return false;
}

class Failover : public testing::Test {
   protected:
    static constexpr std::array kNames = {"a", "b", "c"};

    void start(std::size_t i, int port) {
        servers_[i] = std::make_unique<ServerProcess>(std::vector<std::string>{
            "--port", std::to_string(port), "--server-id", kNames[i], "--max-sessions", "12", "--gpu", "software", "--log-level", "warning"});
        ports_[i] = servers_[i]->port();
    }

    void SetUp() override {
        for (std::size_t i = 0; i < servers_.size(); ++i) {
            start(i, 0);
        }
        balancer_ = std::make_unique<LoadBalancer>(ports_);
        for (int i = 0; i < kViewers; ++i) {
            viewers_.push_back(std::make_unique<LastingViewer>(balancer_->port(), i));
        }
        expectNewFrames("start");
    }

    int countOn(std::size_t server) const {
        return static_cast<int>(std::ranges::count_if(viewers_, [&](const auto& viewer) { return viewer->server() == kNames[server]; }));
    }

    void expectNewFrames(const std::string& when) {
        std::vector<int> before;
        for (const auto& viewer : viewers_) {
            before.push_back(viewer->frames());
        }
        for (std::size_t i = 0; i < viewers_.size(); ++i) {
            EXPECT_TRUE(eventually([&] { return viewers_[i]->frames() >= before[i] + 5; }, 60s))
                << when << ": " << viewers_[i]->name() << " (" << viewers_[i]->scene() << ") sees nothing new from " << viewers_[i]->server();
        }
    }

    // `fault` befalls a server with viewers; they must come to the others.
    void befall(const std::string& what, std::size_t server, const std::function<void()>& fault) {
        ASSERT_GT(countOn(server), 0) << "nobody there to be hurt";
        std::vector<int> arrivals;
        std::vector<bool> hurt;
        for (const auto& viewer : viewers_) {
            viewer->forgetGap();
            arrivals.push_back(viewer->arrivals());
            hurt.push_back(viewer->server() == kNames[server]);
        }
        fault();
        for (std::size_t i = 0; i < viewers_.size(); ++i) {
            EXPECT_TRUE(!hurt[i] || eventually([&] { return viewers_[i]->arrivals() > arrivals[i]; }, 60s)) << what << ": " << viewers_[i]->name();
        }
        expectNewFrames(what);
        std::printf("%-8s", what.c_str());
        for (std::size_t i = 0; i < viewers_.size(); ++i) {
            std::printf(" %5.2f%s", viewers_[i]->longestGapS(), hurt[i] ? "*" : " ");
        }
        std::printf(" s\n");
        std::fflush(stdout);
    }

    // Anyone may be sent there again: HAProxy has seen it answer.
    static void letItBeNoticed() { std::this_thread::sleep_for(1500ms); }

    std::array<std::unique_ptr<ServerProcess>, 3> servers_;
    std::array<int, 3> ports_{};
    std::unique_ptr<LoadBalancer> balancer_;
    std::vector<std::unique_ptr<LastingViewer>> viewers_;
};

TEST_F(Failover, KilledFrozenDrained) {
    std::printf("longest time between two frames of each viewer; *: its server's end\n");
    befall("killed", 0, [&] {
        kill(servers_[0]->pid(), SIGKILL);
        EXPECT_EQ(servers_[0]->wait().exitCode, -SIGKILL);
    });
    start(0, ports_[0]);
    letItBeNoticed();

    befall("frozen", 1, [&] { kill(servers_[1]->pid(), SIGSTOP); });
    kill(servers_[1]->pid(), SIGCONT);
    letItBeNoticed();

    befall("drained", 2, [&] {
        kill(servers_[2]->pid(), SIGTERM);
        EXPECT_EQ(servers_[2]->wait().exitCode, 0);
    });
    start(2, ports_[2]);
    letItBeNoticed();

    expectNewFrames("end");
    for (const auto& viewer : viewers_) {
        EXPECT_THAT(viewer->complaints(), testing::IsEmpty());
    }
    viewers_.clear();
}

}  // namespace
}  // namespace caustream::e2e
