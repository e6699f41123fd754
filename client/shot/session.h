// A Connection seen from a program that has nothing else to do than wait for it.
#pragma once
#include <atomic>
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
    // `stop`, where there is one, ends whatever is waited for once it is true.
    Session(connection::Options options, std::chrono::seconds timeout, const std::atomic<bool>* stop = nullptr);

    using Done = tl::expected<void, Failure>;
    Done connect();
    // Sends a patch, waits until the server took it.
    Done update(const protocol::Json& patch);
    Done showFile(std::vector<std::uint8_t> glb);
    // The same for a patch that names a scene, and waits until state() is what came of it.
    Done show(const protocol::Json& patch);
    // Until the server's resolved document is of this scene, ["builtin", name] or ["asset", sha256]; null: of any.
    Done waitForScene(const protocol::Json& reference);

    // `converge`: as one is drawn at rest.
    tl::expected<connection::Frame, Failure> request(bool still, bool converge);
    tl::expected<connection::Frame, Failure> requestStill(bool converge = false) { return request(true, converge); }
    tl::expected<connection::Frame, Failure> nextStreamed();
    // Streams until the picture has converged, or turns out to have nothing to converge, and tells how far it is.
    Done converge(const std::function<void(const protocol::Convergence&)>& progress);

    // Goes on after a failure that only what was asked for had a part in. False: the connection is lost.
    bool recover();
    // What the server had against it, alone: field, sentence and code; nothing: the last failure was another.
    const std::optional<std::string>& refusal() const { return refusal_; }
    // Milliseconds after which the server will take what it was too busy for; nothing: the last failure was another.
    std::optional<std::uint32_t> retryMs() const { return retryMs_; }

    connection::Connection& connection() { return connection_; }
    const connection::Connection& connection() const { return connection_; }
    const protocol::Welcome& welcome() const { return *welcome_; }
    // What the server said when the scene was there: the file's values and what was asked for until then.
    const protocol::Json& state() const { return state_; }
    const protocol::SceneSummary& scene() const { return scene_; }
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
    protocol::SceneSummary scene_;
    std::uint32_t newestOk_ = 0, okRev_ = 0, stateRev_ = 0;
    bool lost_ = false;
    std::optional<std::uint32_t> retryMs_;
    const std::atomic<bool>* stop_;
    std::optional<protocol::AssetReport> report_;
    std::vector<std::string> warnings_;
    std::vector<double> roundTripsMs_;
    std::optional<Failure> failure_;
    std::optional<std::string> refusal_;
    connection::Connection connection_;
};

}  // namespace caustream::shot
