// A Connection seen from a program that has nothing else to do than wait for it.
#pragma once
#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "client/connection/connection.h"

namespace caustream::shot {

using Failure = std::string;  // one sentence: what, where, what to try

class Session {
 public:
    Session(connection::Options options, std::chrono::seconds timeout);

    using Done = tl::expected<void, Failure>;
    Done connect();
    // Sends a patch, waits until the server took it.
    Done update(const protocol::Json& patch);
    Done showFile(std::vector<std::uint8_t> glb);
    // Until the server's resolved document is of this scene, ["builtin", name] or ["asset", sha256]; null: of any.
    Done waitForScene(const protocol::Json& reference);

    // `converge`: as one is drawn at rest.
    tl::expected<connection::Frame, Failure> requestStill(bool converge = false);
    tl::expected<connection::Frame, Failure> nextStreamed();
    // Streams until the picture has converged, or turns out to have nothing to converge, and tells how far it is.
    Done converge(const std::function<void(const protocol::Convergence&)>& progress);

    connection::Connection& connection() { return connection_; }
    const connection::Connection& connection() const { return connection_; }
    const protocol::Welcome& welcome() const { return *welcome_; }
    // What the server said when the scene was there: the file's values and what was asked for until then.
    const protocol::Json& state() const { return state_; }
    const std::optional<protocol::Stats>& stats() const { return stats_; }
    const std::vector<std::string>& warnings() const { return warnings_; }
    const std::vector<double>& roundTripsMs() const { return roundTripsMs_; }

 private:
    template <class Ready>
    Done waitUntil(const std::string& what, const Ready& ready);
    void take(const connection::Event& event);
    std::string where() const { return address_; }

    std::string address_;
    std::chrono::seconds timeout_;
    std::optional<protocol::Welcome> welcome_;
    std::optional<protocol::Stats> stats_;
    protocol::Json state_;
    std::uint32_t newestOk_ = 0;
    std::optional<protocol::AssetReport> report_;
    std::vector<std::string> warnings_;
    std::vector<double> roundTripsMs_;
    std::optional<Failure> failure_;
    connection::Connection connection_;
};

}  // namespace caustream::shot
