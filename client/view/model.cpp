#include "client/view/model.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace caustream::view {
namespace {

constexpr double kMessageS = 8.0, kErrorS = 15.0;
constexpr double kRestS = 0.2;  // for which a picture is the same before it counts as one that rests
// Fraunhofer lines, um.
constexpr double kF_um = 0.48613, kD_um = 0.58756, kC_um = 0.65627;

glm::dvec3 vec(const protocol::Vec3& v) {
    return {v[0], v[1], v[2]};
}

double sellmeierIndex(const protocol::Sellmeier& glass, double um) {
    double squared = 1.0;
    for (std::size_t i = 0; i < 3; ++i) squared += glass.B[i] * um * um / (um * um - glass.C_um2[i]);
    return std::sqrt(std::max(squared, 1.0));
}

Glass throughLines(double n_d, double spread) {
    const double B = spread / (1.0 / (kF_um * kF_um) - 1.0 / (kC_um * kC_um));
    return {n_d - B / (kD_um * kD_um), B};
}

}  // namespace

Glass glassOf(const protocol::Dispersion& dispersion) {
    if (const auto* constant = std::get_if<protocol::ConstantIndex>(&dispersion)) return {constant->n, 0.0};
    if (const auto* abbe = std::get_if<protocol::Abbe>(&dispersion))
        return throughLines(abbe->n_d, (abbe->n_d - 1.0) / abbe->V_d);
    if (const auto* cauchy = std::get_if<protocol::Cauchy>(&dispersion)) {
        if (cauchy->C_um4 == 0.0) return {cauchy->A, cauchy->B_um2};
        const auto index = [&](double um) {
            return cauchy->A + cauchy->B_um2 / (um * um) + cauchy->C_um4 / std::pow(um, 4);
        };
        return throughLines(index(kD_um), index(kF_um) - index(kC_um));
    }
    const auto& glass = std::get<protocol::Sellmeier>(dispersion);
    return throughLines(sellmeierIndex(glass, kD_um), sellmeierIndex(glass, kF_um) - sellmeierIndex(glass, kC_um));
}

LightModel* Model::editedLight() {
    const auto found = lights.find(light);
    return found == lights.end() ? nullptr : &found->second;
}

glm::dvec3 Model::centre() const {
    const auto& box = scene.casterBounds ? scene.casterBounds : scene.bounds;
    return box ? 0.5 * (vec(box->min) + vec(box->max)) : camera.target;
}

LightPath Model::pathOf(LightModel& edited) const {
    const bool placed = edited.type != protocol::LightType::Directional;
    if (!placed) edited.pose.position = centre() - edited.pose.direction;
    LightPath path{.target = lightTarget(edited.pose, centre())};
    path.distance = glm::distance(path.target, edited.pose.position);
    if (!placed || !scene.bounds) return path;
    const Room room{vec(scene.bounds->min), vec(scene.bounds->max)};
    if (room.holds(edited.pose.position) && room.holds(path.target)) path.room = room;
    return path;
}

bool Model::can(const std::string& cap) const {
    return welcome && std::ranges::find(welcome->caps, cap) != welcome->caps.end();
}

void Model::shown(const protocol::FrameHeader& header, double nowS) {
    frame = header;
    if (header.stateRev == shownRev_) return;
    shownRev_ = header.stateRev;
    shownSinceSeq_ = header.frameSeq;
    shownSinceS_ = nowS;
}

const protocol::Convergence* Model::convergence(double nowS) const {
    const bool current = connected && stats && stats->convergence && stats->frameSeq >= shownSinceSeq_;
    return current && nowS - shownSinceS_ >= kRestS ? &*stats->convergence : nullptr;
}

void Model::say(bool error, std::string text, double nowS) {
    std::erase_if(messages, [&](const Message& message) { return message.text == text; });
    messages.push_back({error, std::move(text), nowS + (error ? kErrorS : kMessageS)});
    if (messages.size() > 6) messages.erase(messages.begin());
}

bool Model::takeState(const protocol::StateMessage& message, double nowS) {
    const auto decoded = protocol::decodeState(message.state);
    if (!decoded) {
        say(true, "the scene's state was not understood: " + decoded.error().message, nowS);
        return false;
    }
    const bool another = !haveScene || scene.name != message.scene.name || sceneRef != decoded->scene;
    haveScene = true;
    scene = message.scene;
    sceneRef = decoded->scene;
    transport = decoded->transport;
    stream = decoded->stream;
    upload.reset();

    const protocol::CameraState& c = decoded->camera;
    if (c.eye) camera.eye = vec(*c.eye);
    if (c.target) camera.target = vec(*c.target);
    if (c.up) camera.up = vec(*c.up);
    if (c.fovYDeg) camera.fovYDeg = *c.fovYDeg;
    exposureEv = c.exposureEv;
    if (!scene.cameras.empty()) {
        const auto& first = scene.cameras.front();
        startCamera = {vec(first.eye), vec(first.target), vec(first.up), first.fovYDeg};
    } else if (another) {
        startCamera = camera;
    }

    lights.clear();
    for (const auto& summary : scene.lights) {
        LightModel& model = lights[summary.name];
        model.type = summary.type;
        const auto found = decoded->lights.find(summary.name);
        if (found == decoded->lights.end()) continue;
        const protocol::LightState& given = found->second;
        if (given.type) model.type = *given.type;
        if (given.position) model.pose.position = vec(*given.position);
        if (given.direction) model.pose.direction = vec(*given.direction);
        if (given.halfAngleDeg) model.halfAngleDeg = *given.halfAngleDeg;
        if (given.innerAngleDeg) model.innerAngleDeg = *given.innerAngleDeg;
        if (given.intensity) model.intensity = *given.intensity;
    }
    if (!lights.contains(light)) light = scene.lights.empty() ? "" : scene.lights.front().name;

    glasses.clear();
    for (const auto& summary : scene.materials) {
        if (!summary.caster) continue;
        const auto found = decoded->materials.find(summary.name);
        const bool known = found != decoded->materials.end() && found->second.dispersion;
        glasses[summary.name] = known ? glassOf(*found->second.dispersion) : Glass{};
    }
    if (!glasses.contains(material)) material = glasses.empty() ? "" : glasses.begin()->first;
    if (another)
        for (const auto& warning : scene.warnings) say(false, warning, nowS);
    return another;
}

bool Model::take(const connection::Event& event, double nowS) {
    bool another = false;
    std::visit(
        [&]<class T>(const T& value) {
            if constexpr (std::is_same_v<T, protocol::Welcome>) {
                welcome = value;
                connected = true;
                gaveUp = false;
                connection = value.gpu;
                statuses.clear();
                stats.reset();  // a new connection counts its frames from 1 again
                shownRev_ = shownSinceSeq_ = 0;
            } else if constexpr (std::is_same_v<T, protocol::StateMessage>) {
                another = takeState(value, nowS);
            } else if constexpr (std::is_same_v<T, protocol::Ok>) {
                if (value.recording) recording = *value.recording;
            } else if constexpr (std::is_same_v<T, protocol::ErrorMessage>) {
                upload.reset();
                say(true, (value.field && !value.field->empty() ? *value.field + ": " : "") + value.message, nowS);
            } else if constexpr (std::is_same_v<T, protocol::Stats>) {
                stats = value;
            } else if constexpr (std::is_same_v<T, protocol::Status>) {
                if (value.message.empty())
                    statuses.erase(value.key);
                else
                    statuses[value.key] = value;
            } else if constexpr (std::is_same_v<T, connection::RoundTrip>) {
                roundTripMs = value.ms;
            } else if constexpr (std::is_same_v<T, connection::UploadProgress>) {
                upload = value;
            } else if constexpr (std::is_same_v<T, connection::BadMessage>) {
                say(true, value.why, nowS);
            } else if constexpr (std::is_same_v<T, connection::Disconnected>) {
                connected = false;
                gaveUp = !value.willRetry;
                connection = gaveUp ? value.why : "reconnecting: " + value.why;
                recording.clear();
                upload.reset();
                statuses.clear();
            }
        },
        event);
    return another;
}

}  // namespace caustream::view
