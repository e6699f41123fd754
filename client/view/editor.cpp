#include "client/view/editor.h"

#include <algorithm>

#include "protocol/patch.h"

namespace caustream::view {
namespace {

using protocol::Json;

constexpr double kFlushEveryS = 0.012;  // 80 messages a second at most; the server allows 300 of all kinds

Json vec(const glm::dvec3& v) {
    return Json::array({v.x, v.y, v.z});
}

Json posed(const LightModel& light) {
    Json json = {{"direction", vec(light.pose.direction)}};
    if (light.type != protocol::LightType::Directional) json["position"] = vec(light.pose.position);
    return json;
}

const char* nameOf(protocol::Intensity::Unit unit) {
    return unit == protocol::Intensity::Unit::Candela ? "cd" : unit == protocol::Intensity::Unit::Watt ? "W" : "lx";
}

}  // namespace

void Editor::change(const Json& patch) {
    changes_.merge_patch(patch);
}

void Editor::cameraMoved() {
    const Pose& pose = model_.camera;
    moves_["camera"] = {
        {"eye", vec(pose.eye)}, {"target", vec(pose.target)}, {"up", vec(pose.up)}, {"fov_y_deg", pose.fovYDeg}};
}

void Editor::lightMoved(const std::string& name) {
    const auto found = model_.lights.find(name);
    if (found != model_.lights.end()) moves_["lights"][name] = posed(found->second);
}

void Editor::lightChanged(const std::string& name) {
    const auto found = model_.lights.find(name);
    if (found == model_.lights.end()) return;
    const LightModel& light = found->second;
    Json json = {{"intensity", {nameOf(light.intensity.unit), light.intensity.value}}};
    if (light.type == protocol::LightType::Spot) {
        json["half_angle_deg"] = light.halfAngleDeg;
        json["inner_angle_deg"] = std::min(light.innerAngleDeg, light.halfAngleDeg);
    }
    moves_["lights"][name].merge_patch(json);
}

void Editor::glassChanged(const std::string& material) {
    const auto found = model_.glasses.find(material);
    if (found == model_.glasses.end()) return;
    changes_["materials"][material]["dispersion"] = {"cauchy", found->second.A, found->second.B_um2};
}

void Editor::showScene(const protocol::SceneRef& scene) {
    moves_ = Json::object();
    changes_ = Json::object();
    // At once and alone: its nulls, which take the old scene's overrides away, would be lost in a merge with what
    // follows.
    connection_.update(protocol::sceneChange(scene));
}

void Editor::showTarget(const std::string& target) {
    const bool map = target == "spectral";
    change(
        {{"stream",
          {{"target", target}, {"encoding", map ? "raw" : "jpeg"}, {"sample", map ? "f16" : "u8"}, {"bands", "rgb"}}}});
}

void Editor::flush(double nowS) {
    if (!pending() || nowS - lastFlushS_ < kFlushEveryS) return;
    lastFlushS_ = nowS;
    if (!changes_.empty()) {
        if (const auto sent = connection_.update(changes_); !sent)
            model_.say(true, sent.error().field + ": " + sent.error().message, nowS);
        changes_ = Json::object();
    }
    if (!moves_.empty()) {
        if (const auto sent = connection_.input(moves_); !sent)
            model_.say(true, sent.error().field + ": " + sent.error().message, nowS);
        moves_ = Json::object();
    }
}

}  // namespace caustream::view
