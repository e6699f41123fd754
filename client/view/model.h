// What the window shows and edits: the server's last word on the scene, and our own changes to it since.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "client/connection/events.h"
#include "client/view/poses.h"

namespace caustream::view {

// A light as the panel edits it.
struct LightModel {
    protocol::LightType type = protocol::LightType::Spot;
    LightPose pose;
    double halfAngleDeg = 45.0, innerAngleDeg = 0.0;
    protocol::Intensity intensity;
};

// Glass as two numbers: n = A + B / l^2, l in um.
struct Glass {
    double A = 1.458, B_um2 = 0.00354;
};
// The Cauchy pair with the same index at the d line and the same difference between the F and C lines.
Glass glassOf(const protocol::Dispersion& dispersion);

struct Message {
    bool error = false;
    std::string text;
    double untilS = 0.0;  // seconds of the window's clock; then it goes
};

struct Model {
    bool connected = false, gaveUp = false;  // gaveUp: there will be no other attempt by itself
    std::string connection = "connecting";   // one line
    std::string following;                   // the view id of whose scene is shown; empty: our own
    std::string recording;                   // the file on the server; empty: nothing is recorded
    std::optional<protocol::Welcome> welcome;
    protocol::SceneSummary scene;
    bool haveScene = false;

    Pose camera, startCamera;
    std::optional<double> exposureEv;  // nothing: automatic
    std::map<std::string, LightModel> lights;
    std::string light;                     // the one that is edited and dragged
    std::map<std::string, Glass> glasses;  // of the casters' materials
    std::string material;
    protocol::SceneRef sceneRef;
    std::string fileName;  // of the newest file that was sent
    protocol::TransportState transport;
    protocol::StreamState stream;

    std::optional<protocol::Stats> stats;
    std::optional<connection::UploadProgress> upload;
    std::map<std::string, protocol::Status> statuses;
    std::vector<Message> messages;

    double roundTripMs = 0, latencyMs = 0, ageMs = 0, frameRate = 0, decodeMs = 0;
    protocol::FrameHeader frame;  // on the screen

    bool can(const std::string& cap) const;  // of the server
    // A frame is on the screen.
    void shown(const protocol::FrameHeader& header, double nowS);
    // How far the picture on the screen has come, once it rests; nothing: it moves, or has nothing to converge.
    const protocol::Convergence* convergence(double nowS) const;

    LightModel* editedLight();
    // Takes what an event says. True when the scene is another one than before.
    bool take(const connection::Event& event, double nowS);
    void say(bool error, std::string text, double nowS);
    // The middle of the casters, or of the scene.
    glm::dvec3 centre() const;
    // What a drag moves the light along; gives a directional light a place to be moved from.
    LightPath pathOf(LightModel& edited) const;

 private:
    std::uint32_t shownRev_ = 0, shownSinceSeq_ = 0;  // the state on the screen, and its first frame
    double shownSinceS_ = 0.0;

    bool takeState(const protocol::StateMessage& message, double nowS);
};

}  // namespace caustream::view
