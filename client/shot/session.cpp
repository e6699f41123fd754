#include "client/shot/session.h"

#include "client/connection/closing.h"

namespace caustream::shot {

using protocol::Json;

Session::Session(connection::Options options, std::chrono::seconds timeout, const std::atomic<bool>* stop)
    : address_(options.address.text()), timeout_(timeout), stop_(stop), connection_(std::move(options)) {}

void Session::take(const connection::Event& event) {
    std::visit(
        [this]<class T>(const T& value) {
            if constexpr (std::is_same_v<T, protocol::Welcome>) {
                welcome_ = value;
            } else if constexpr (std::is_same_v<T, protocol::Ok>) {
                newestOk_ = std::max(newestOk_, value.id);
                okRev_ = value.rev.value_or(okRev_);
                if (value.report) report_ = value.report;
            } else if constexpr (std::is_same_v<T, protocol::ErrorMessage>) {
                const std::string field = value.field && !value.field->empty() ? *value.field + ": " : "";
                refusal_ = field + value.message + " (" + std::string(protocol::errorName(value.code)) + ")";
                failure_ = where() + " refused: " + *refusal_;
                retryMs_ = value.retryMs;
            } else if constexpr (std::is_same_v<T, protocol::StateMessage>) {
                state_ = value.state;
                stateRev_ = value.rev;
                scene_ = value.scene;
                warnings_ = value.scene.warnings;
            } else if constexpr (std::is_same_v<T, protocol::Stats>) {
                stats_ = value;
            } else if constexpr (std::is_same_v<T, connection::RoundTrip>) {
                roundTripsMs_.push_back(value.ms);
            } else if constexpr (std::is_same_v<T, connection::BadMessage>) {
                failure_ = where() + ": " + value.why + "; are server and client of the same version?";
            } else if constexpr (std::is_same_v<T, connection::Disconnected>) {
                lost_ = true;
                if (failure_) return;  // the error that came before it says more
                if (value.closeCode == connection::kBadCertificate) {
                    failure_ = "cannot reach " + where() + ": " + value.why;
                    return;
                }
                failure_ = welcome_ ? "lost the connection to " + where() + ": " + value.why + "; see the server's log"
                                    : "cannot reach " + where() + ": " + value.why +
                                          "; is caustream-server running there? Its ready line shows the address";
            }
        },
        event);
}

template <class Ready>
Session::Done Session::waitUntil(const std::string& what, const Ready& ready) {
    const auto last = std::chrono::steady_clock::now() + timeout_;
    const auto takeAll = [this] {
        for (const auto& event : connection_.takeEvents()) take(event);
    };
    for (;;) {
        takeAll();
        if (failure_) return tl::make_unexpected(*failure_);
        if (stop_ && *stop_) return tl::make_unexpected("stopped");
        if (ready()) {
            takeAll();  // what came before a frame, but after the look above: its statistics
            return {};
        }
        if (std::chrono::steady_clock::now() > last)
            return tl::make_unexpected("waited " + std::to_string(timeout_.count()) + " s for " + what + " from " +
                                       where() + "; try --timeout");
        connection_.wait(std::chrono::milliseconds(200));
    }
}

Session::Done Session::connect() {
    return waitUntil("a welcome", [this] { return welcome_.has_value(); });
}

Session::Done Session::update(const Json& patch) {
    const auto id = connection_.update(patch);
    if (!id) return tl::make_unexpected(id.error().field + ": " + id.error().message);
    return waitUntil("the answer to a change", [&] { return newestOk_ >= *id; });
}

Session::Done Session::show(const Json& patch) {
    if (auto updated = update(patch); !updated) return updated;
    const std::uint32_t rev = okRev_;
    return waitUntil("the scene", [&] { return state_.is_object() && stateRev_ >= rev; });
}

bool Session::recover() {
    failure_.reset();
    refusal_.reset();
    retryMs_.reset();
    return !lost_;
}

Session::Done Session::showFile(std::vector<std::uint8_t> glb) {
    report_.reset();
    const Json reference = {"asset", connection::sha256Hex(glb)};
    connection_.showFile(std::move(glb));
    if (auto uploaded = waitUntil("the file's scene", [this] { return report_.has_value(); }); !uploaded)
        return uploaded;
    return waitForScene(reference);
}

Session::Done Session::waitForScene(const Json& reference) {
    return waitUntil("the scene", [&] {
        return state_.is_object() && (reference.is_null() || state_.value("scene", Json{}) == reference);
    });
}

tl::expected<connection::Frame, Failure> Session::request(bool still, bool converge) {
    connection_.requestFrame(still, converge);
    std::optional<connection::Frame> frame;
    const auto done = waitUntil("a frame", [&] { return (frame = connection_.takeRequested()).has_value(); });
    if (!done) return tl::make_unexpected(done.error());
    return std::move(*frame);
}

tl::expected<connection::Frame, Failure> Session::nextStreamed() {
    std::optional<connection::Frame> frame;
    const auto done = waitUntil("a frame", [&] { return (frame = connection_.takeFrame()).has_value(); });
    if (!done) return tl::make_unexpected(done.error());
    return std::move(*frame);
}

Session::Done Session::converge(const std::function<void(const protocol::Convergence&)>& progress) {
    stats_.reset();
    connection_.startStream(true);
    std::uint32_t told = 0;
    bool converged = false;
    Done done;
    // Each frame is waited for, not all of them: as long as there is progress, there is no hurry.
    while (done && !converged && (!stats_ || stats_->convergence)) {
        done = waitUntil("the picture to converge", [&] {
            const auto frame = connection_.takeFrame();
            if (frame) {
                connection_.acknowledge(*frame, 0);
                converged |= (frame->header.flags & protocol::kFrameConverged) != 0;
            }
            const bool news = stats_ && stats_->frameSeq != told;
            if (news && stats_->convergence) progress(*stats_->convergence);
            if (news) told = stats_->frameSeq;
            return frame || news;
        });
    }
    connection_.pauseStream();
    return done;
}

}  // namespace caustream::shot
