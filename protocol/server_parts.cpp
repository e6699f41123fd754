#include "protocol/server_parts.h"

namespace caustream::protocol {
namespace {

// Each limit and its name, once for both directions.
template <class AnyLimits, class Visit>
void eachLimit(AnyLimits& limits, Visit visit) {
    visit("text_bytes", limits.textBytes);
    visit("server_text_bytes", limits.serverTextBytes);
    visit("depth", limits.depth);
    visit("binary_bytes", limits.binaryBytes);
    visit("chunk_bytes", limits.chunkBytes);
    visit("credit_bytes", limits.creditBytes);
    visit("asset_bytes", limits.assetBytes);
    visit("state_bytes", limits.stateBytes);
    visit("frame_min_side", limits.frameMinSide);
    visit("frame_max_side", limits.frameMaxSide);
    visit("frame_pixels", limits.framePixels);
    visit("frame_payload_bytes", limits.framePayloadBytes);
    visit("bands", limits.bands);
    visit("sessions", limits.sessions);
    visit("viewer_bytes", limits.viewerBytes);
    visit("asset_cache_bytes", limits.assetCacheBytes);
    visit("gpu_ms_per_s", limits.gpuMsPerS);
    visit("messages_per_s", limits.messagesPerS);
    visit("hello_s", limits.helloS);
    visit("ping_s", limits.pingS);
    visit("dead_s", limits.deadS);
    visit("idle_pause_s", limits.idlePauseS);
    visit("idle_close_s", limits.idleCloseS);
    visit("resume_s", limits.resumeS);
}

template <class AnyLedger, class Visit>
void eachFlux(AnyLedger& ledger, Visit visit) {
    visit("on_casters", ledger.onCasters);
    visit("deposited", ledger.deposited);
    visit("absorbed", ledger.absorbed);
    visit("reflected", ledger.reflected);
    visit("total_reflection", ledger.totalReflection);
    visit("rejected", ledger.rejected);
    visit("left_map", ledger.leftMap);
    visit("no_receiver", ledger.noReceiver);
    visit("cut", ledger.cut);
}

constexpr double kAnyNumber = 1e300;

Box decodeBox(const Item& item) {
    Fields in(item);
    Box box{in.at("min").vec3(-kAnyNumber, kAnyNumber), in.at("max").vec3(-kAnyNumber, kAnyNumber)};
    in.finish();
    return box;
}

MaterialSummary decodeMaterial(const Item& item) {
    Fields in(item);
    MaterialSummary material{in.at("name").text(kSentenceBytes), in.at("caster").boolean()};
    in.finish();
    return material;
}

LightSummary decodeLight(const Item& item) {
    Fields in(item);
    LightSummary light{in.at("name").text(kSentenceBytes), in.at("type").oneOf(kLightTypes)};
    in.finish();
    return light;
}

CameraSummary decodeCamera(const Item& item) {
    Fields in(item);
    CameraSummary camera;
    camera.name = in.at("name").text(kSentenceBytes);
    camera.eye = in.at("eye").vec3(-kAnyNumber, kAnyNumber);
    camera.target = in.at("target").vec3(-kAnyNumber, kAnyNumber);
    camera.up = in.at("up").vec3(-kAnyNumber, kAnyNumber);
    camera.fovYDeg = in.at("fov_y_deg").number(0, 180);
    in.finish();
    return camera;
}

Json toJson(const Box& box) {
    return {{"min", box.min}, {"max", box.max}};
}

}  // namespace

Limits decodeLimits(const Item& item) {
    Limits limits;
    Fields in(item);
    eachLimit(limits, [&](const char* name, auto& limit) {
        using Value = std::remove_reference_t<decltype(limit)>;
        if (const auto v = in.find(name)) limit = static_cast<Value>(v->integer(0, kMaxU32));
    });
    in.finish();
    return limits;
}

Json toJson(const Limits& limits) {
    Json json = Json::object();
    eachLimit(limits, [&](const char* name, const auto& limit) { json[name] = limit; });
    return json;
}

Ledger decodeLedger(const Item& item) {
    Ledger ledger;
    Fields in(item);
    eachFlux(ledger, [&](const char* name, double& flux) { flux = in.at(name).number(-kAnyNumber, kAnyNumber); });
    in.finish();
    return ledger;
}

Json toJson(const Ledger& ledger) {
    Json json = Json::object();
    eachFlux(ledger, [&](const char* name, const double& flux) { json[name] = flux; });
    return json;
}

SceneSummary decodeSceneSummary(const Item& item) {
    Fields in(item);
    SceneSummary scene;
    scene.name = in.at("name").text(kSentenceBytes);
    if (const auto v = in.find("bounds")) scene.bounds = decodeBox(*v);
    if (const auto v = in.find("caster_bounds")) scene.casterBounds = decodeBox(*v);
    scene.triangles = in.at("triangles").u32();
    scene.casters = in.at("casters").texts(kListCount, kSentenceBytes);
    scene.receivers = in.at("receivers").texts(kListCount, kSentenceBytes);
    scene.materials = decodeList(in.at("materials"), decodeMaterial);
    scene.lights = decodeList(in.at("lights"), decodeLight);
    scene.cameras = decodeList(in.at("cameras"), decodeCamera);
    scene.warnings = in.at("warnings").texts(kListCount, kSentenceBytes);
    in.finish();
    return scene;
}

Json toJson(const SceneSummary& scene) {
    Json json = {{"name", scene.name},           {"triangles", scene.triangles}, {"casters", scene.casters},
                 {"receivers", scene.receivers}, {"warnings", scene.warnings},   {"materials", Json::array()},
                 {"lights", Json::array()},      {"cameras", Json::array()}};
    if (scene.bounds) json["bounds"] = toJson(*scene.bounds);
    if (scene.casterBounds) json["caster_bounds"] = toJson(*scene.casterBounds);
    for (const MaterialSummary& material : scene.materials)
        json["materials"].push_back({{"name", material.name}, {"caster", material.caster}});
    for (const LightSummary& light : scene.lights)
        json["lights"].push_back({{"name", light.name}, {"type", nameOf(kLightTypes, light.type)}});
    for (const CameraSummary& camera : scene.cameras)
        json["cameras"].push_back({{"name", camera.name},
                                   {"eye", camera.eye},
                                   {"target", camera.target},
                                   {"up", camera.up},
                                   {"fov_y_deg", camera.fovYDeg}});
    return json;
}

}  // namespace caustream::protocol
