#include "lasting_viewer.h"

#include <array>

namespace caustream::e2e {
namespace {

using namespace std::chrono_literals;

constexpr std::array kScenes = {"sphere", "prism", "gem"};
constexpr auto kRetry = 300ms;      // from a connection that broke to the next try, and a little more for each viewer
constexpr auto kMove = 150ms;       // between poses
constexpr int kSilenceMs = 10'000;  // longer than the load balancer takes to notice anything

}  // namespace

LastingViewer::LastingViewer(int port, int number) : port_(port), number_(number), lastFrame_(Clock::now()) {
    document_ = {{"scene", {"builtin", scene()}},
                 {"camera", camera(0)},
                 {"transport", {{"mode", "refined"}, {"wavelengths", 7}, {"photon_grid", 64}, {"map_size", 64}}},
                 {"stream", {{"width", 48}, {"height", 48}, {"encoding", "raw"}, {"quality", {"fixed", 90}}, {"max_fps", 10}}}};
    thread_ = std::thread([this] { live(); });
}

LastingViewer::~LastingViewer() {
    leaving_ = true;
    thread_.join();
}

std::string LastingViewer::scene() const { return kScenes[static_cast<std::size_t>(number_) % kScenes.size()]; }

std::string LastingViewer::server() const {
    const std::lock_guard lock(mutex_);
    return server_;
}

double LastingViewer::longestGapS() const {
    const std::lock_guard lock(mutex_);
    return std::chrono::duration<double>(longestGap_).count();
}

void LastingViewer::forgetGap() {
    const std::lock_guard lock(mutex_);
    longestGap_ = {};
}

std::vector<std::string> LastingViewer::complaints() const {
    const std::lock_guard lock(mutex_);
    return complaints_;
}

// Of this viewer alone: no two of the twelve look from the same place.
Json LastingViewer::camera(int pose) const {
    return {{"eye", {1.5 + 0.1 * number_, 2.0 + 0.2 * pose, 2.5}}, {"target", {0.0, 0.5, 0.0}}, {"up", {0.0, 1.0, 0.0}}, {"fov_y_deg", 50.0}};
}

void LastingViewer::live() {
    bool farewell = true;
    while (!leaving_) {
        pause_ = kRetry + number_ * 10ms;
        try {
            const std::string wish = farewell ? "" : "?srv=" + server();
            farewell = true;  // a server that cannot be reached is not asked for twice
            RawClient client(port_, "/ws" + wish);
            arrive(client);
            farewell = stay(client);
        } catch (const std::exception&) {
            // No server just now, or gone in the middle of a word: the next one.
        }
        std::this_thread::sleep_for(pause_);
    }
}

void LastingViewer::arrive(RawClient& client) {
    Json hello = {{"caps", {"raw"}}};
    if (session_.empty()) {
        const Json welcome = client.hello(hello);
        client.update(document_);
        for (pose_ = kPoses - 1; pose_ > 0; --pose_) {  // how all of them look, to know them again
            client.update({{"camera", camera(pose_)}});
            comparePicture(client);
        }
        client.update({{"camera", camera(0)}});
        session_ = welcome["session"];
        const std::lock_guard lock(mutex_);
        server_ = welcome["server"];
    } else {
        hello["resume"] = {{"session", session_}, {"state", document_}, {"input_seq", inputSeq_}};
        const Json welcome = client.hello(hello);
        session_ = welcome["session"];
        Json complete = welcome["state"];  // with defaults beside what was asked for
        complete.merge_patch(document_);
        if (welcome["state"] != complete) {
            complain("its document came back as " + welcome["state"].dump());
        }
        const std::lock_guard lock(mutex_);
        server_ = welcome["server"];
    }
    comparePicture(client);
    client.ask({{"op", "stream.start"}});
    ++arrivals_;
}

// The same scene from the same place has the same bits, whichever server drew it.
void LastingViewer::comparePicture(RawClient& client) {
    const Picture picture = client.requestFrame();
    client.ack(picture.header.frameSeq);
    auto& before = pictures_[static_cast<std::size_t>(pose_)];
    if (before && *before != picture.payload) {
        complain("pose " + std::to_string(pose_) + " looks different from before");
    }
    before = picture.payload;
}

bool LastingViewer::stay(RawClient& client) {
    auto moved = Clock::now(), heard = moved;
    bool farewell = false;
    while (!leaving_) {
        if (Clock::now() - moved > kMove && !farewell) {
            moved = Clock::now();
            pose_ = (pose_ + 1) % kPoses;
            document_["camera"] = camera(pose_);
            client.json({{"op", "input"}, {"seq", ++inputSeq_}, {"t_us", inputSeq_}, {"camera", camera(pose_)}});
        }
        const Message message = client.next(50);
        if (message.kind == Message::Kind::Silence) {
            if (Clock::now() - heard > std::chrono::milliseconds(kSilenceMs)) {
                return true;
            }
            continue;
        }
        heard = Clock::now();
        if (message.kind == Message::Kind::Close) {
            return farewell;
        }
        if (message.kind == Message::Kind::Binary) {
            if (const auto header = protocol::decodeFrameHeader(message.bytes)) {
                client.ack(header->frameSeq);
                sawFrame();
            }
        } else if (const Json text = Json::parse(message.text); text.value("op", "") == "goaway") {
            farewell = true;
            const int jitterMs = text["jitter_ms"];
            pause_ = std::chrono::milliseconds(static_cast<int>(text["reconnect_ms"]) + number_ * jitterMs / 12);
        } else if (text.value("op", "") == "error") {
            complain("the server says " + message.text);
        }
    }
    return farewell;
}

void LastingViewer::sawFrame() {
    ++frames_;
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    longestGap_ = std::max(longestGap_, now - lastFrame_);
    lastFrame_ = now;
}

void LastingViewer::complain(std::string what) {
    const std::lock_guard lock(mutex_);
    complaints_.push_back(name() + ": " + std::move(what));
}

}  // namespace caustream::e2e
