// A viewer that outlives its servers: keeps the state document, and brings it to whatever server it comes to next, as
// protocol/README.md says. A thread of its own; it moves between four poses all the time.
#pragma once
#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "../raw_client.h"

namespace caustream::e2e {

class LastingViewer {
   public:
    static constexpr int kPoses = 4;

    LastingViewer(int port, int number);
    ~LastingViewer();

    std::string name() const { return "viewer " + std::to_string(number_); }
    std::string scene() const;
    std::string server() const;        // the one it is with, or was
    int frames() const { return frames_; }
    int arrivals() const { return arrivals_; }  // at a server, the first one too
    double longestGapS() const;        // between two frames, since forgetGap()
    void forgetGap();
    std::vector<std::string> complaints() const;  // what was lost: a document, a pose's picture

   private:
    using Clock = std::chrono::steady_clock;

    void live();
    // Until the connection ends. True if it was a farewell: this server is not to be asked for again.
    bool stay(RawClient& client);
    void arrive(RawClient& client);
    void comparePicture(RawClient& client);
    void sawFrame();
    void complain(std::string what);
    Json camera(int pose) const;

    const int port_, number_;
    Json document_;                                 // whoever serves, this is what is wanted
    int pose_ = 0;
    std::string session_;
    std::uint32_t inputSeq_ = 0;
    std::chrono::milliseconds pause_{};             // before the next connection
    std::array<std::optional<std::vector<std::uint8_t>>, kPoses> pictures_;  // of the first server that drew each
    std::atomic<int> frames_{0}, arrivals_{0};
    std::atomic<bool> leaving_{false};

    mutable std::mutex mutex_;
    std::string server_;                   // guarded by mutex_
    std::vector<std::string> complaints_;  // guarded by mutex_
    Clock::time_point lastFrame_;          // guarded by mutex_
    Clock::duration longestGap_{};         // guarded by mutex_

    std::thread thread_;
};

}  // namespace caustream::e2e
