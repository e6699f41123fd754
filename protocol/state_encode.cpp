#include "protocol/choices.h"

namespace caustream::protocol {
namespace {

template <class T>
void put(Json& object, const char* key, const std::optional<T>& value) {
    if (value) object[key] = *value;
}

Json toJson(const Spectrum& spectrum) {
    Json tagged = Json::array({nameOf(kSpectra, spectrum.index())});
    if (const auto* blackbody = std::get_if<Blackbody>(&spectrum)) tagged.push_back(blackbody->kelvin);
    if (const auto* lines = std::get_if<Lines>(&spectrum))
        for (const double nm : lines->nm) tagged.push_back(nm);
    return tagged;
}

Json toJson(const LightState& light) {
    Json object = Json::object();
    if (light.type) object["type"] = nameOf(kLightTypes, *light.type);
    put(object, "position", light.position);
    put(object, "direction", light.direction);
    put(object, "half_angle_deg", light.halfAngleDeg);
    put(object, "inner_angle_deg", light.innerAngleDeg);
    if (light.intensity)
        object["intensity"] = Json::array({nameOf(kIntensityUnits, light.intensity->unit), light.intensity->value});
    put(object, "color", light.color);
    if (light.spectrum) object["spectrum"] = toJson(*light.spectrum);
    if (light.cookie) {
        Json tagged = Json::array({nameOf(kCookies, light.cookie->texture.has_value())});
        if (light.cookie->texture) tagged.push_back(*light.cookie->texture);
        object["cookie"] = std::move(tagged);
    }
    return object;
}

Json toJson(const MaterialState& material) {
    Json object = Json::object();
    if (material.dispersion) object["dispersion"] = protocol::toJson(*material.dispersion);
    if (material.absorption) object["absorption"] = Json::array({material.absorption->nm, material.absorption->perM});
    return object;
}

Json toJson(const CameraState& camera) {
    Json object = Json::object();
    put(object, "eye", camera.eye);
    put(object, "target", camera.target);
    put(object, "up", camera.up);
    put(object, "fov_y_deg", camera.fovYDeg);
    object["exposure"] = camera.exposureEv ? Json::array({"ev", *camera.exposureEv}) : Json::array({"auto"});
    return object;
}

Json toJson(const TransportState& transport) {
    return {
        {"mode", nameOf(kTransportModes, transport.mode)},
        {"wavelengths", !transport.wavelengthsNm.empty()           ? Json(transport.wavelengthsNm)
                        : transport.wavelengths == kContinuous ? Json(kContinuousName)
                                                               : Json(transport.wavelengths)},
        {"photon_grid", transport.photonGrid},
        {"map_size", transport.mapSize},
        {"back_steps", transport.backSteps},
        {"receiver_steps", transport.receiverSteps},
        {"gap_fill", transport.gapFill},
        {"filter", transport.filter},
        {"force_dispersive", transport.forceDispersive},
        {"hierarchy_levels", transport.hierarchyLevels},
        {"bounces", transport.bounces},
        {"exact_receivers", transport.exactReceivers},
        {"budget_ms", transport.budgetMs},
        {"target_error", transport.targetError}};
}

Json toJson(const StreamState& stream) {
    return {{"target", targetName(stream.target, stream.pass)},
            {"encoding", nameOf(kEncodings, stream.encoding)},
            {"sample", nameOf(kSamples, stream.sample)},
            {"bands", nameOf(kBands, stream.wavelengthBands)},
            {"width", stream.width},
            {"height", stream.height},
            {"quality", stream.jpegQuality ? Json::array({"fixed", *stream.jpegQuality}) : Json::array({"auto"})},
            {"max_fps", stream.maxFps}};
}

}  // namespace

Json toJson(const Dispersion& dispersion) {
    Json tagged = Json::array({nameOf(kDispersions, dispersion.index())});
    const auto add = [&](double value) { tagged.push_back(value); };
    if (const auto* constant = std::get_if<ConstantIndex>(&dispersion)) {
        add(constant->n);
    } else if (const auto* cauchy = std::get_if<Cauchy>(&dispersion)) {
        add(cauchy->A);
        add(cauchy->B_um2);
        if (cauchy->C_um4 != 0.0) add(cauchy->C_um4);
    } else if (const auto* abbe = std::get_if<Abbe>(&dispersion)) {
        add(abbe->n_d);
        add(abbe->V_d);
    } else if (const auto* sellmeier = std::get_if<Sellmeier>(&dispersion)) {
        for (const double b : sellmeier->B) add(b);
        for (const double c : sellmeier->C_um2) add(c);
    }
    return tagged;
}

std::string targetName(Target target, const std::string& pass) {
    return target == Target::Composite ? "composite" : target == Target::Spectral ? "spectral" : pass;
}

Json toJson(const State& state) {
    Json document = Json::object();
    document["scene"] = Json::array({nameOf(kSceneKinds, state.scene.kind), state.scene.name});
    document["lights"] = Json::object();
    for (const auto& [name, light] : state.lights) document["lights"][name] = toJson(light);
    document["materials"] = Json::object();
    for (const auto& [name, material] : state.materials) document["materials"][name] = toJson(material);
    document["camera"] = toJson(state.camera);
    document["environment"] = Json::object();
    put(document["environment"], "color", state.environmentColor);
    put(document, "outside_index", state.outsideIndex);
    document["transport"] = toJson(state.transport);
    document["stream"] = toJson(state.stream);
    return document;
}

}  // namespace caustream::protocol
