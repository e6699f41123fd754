#include "protocol/server_messages.h"
#include "protocol/server_parts.h"

namespace caustream::protocol {
namespace {

constexpr double kAnyNumber = 1e300;

GlassPreset decodeGlass(const Item& item) {
    Fields in(item);
    GlassPreset glass{in.at("name").text(kNameBytes, 1), decodeDispersion(in.at("dispersion"))};
    in.finish();
    return glass;
}

ServerMessage decodeWelcome(Fields& in) {
    Welcome welcome;
    welcome.id = requestId(in);
    welcome.session = in.at("session").text(kNameBytes, 1);
    if (const auto v = in.find("view_id")) welcome.viewId = v->text(kNameBytes);
    welcome.server = in.at("server").text(kNameBytes, 1);
    welcome.protocol = in.at("protocol").text(kNameBytes, 1);
    welcome.build = in.at("build").text(kTextBytes);
    welcome.gpu = in.at("gpu").text(kTextBytes);
    welcome.resumed = in.at("resumed").boolean();
    welcome.rev = in.at("rev").u32();
    welcome.state = in.at("state").object();
    welcome.caps = in.at("caps").texts(64, 64);
    welcome.scenes = in.at("scenes").texts(kListCount, kNameBytes);
    welcome.passes = in.at("passes").texts(kListCount, kNameBytes);
    welcome.limits = decodeLimits(in.at("limits"));
    welcome.glasses = decodeList(in.at("glasses"), decodeGlass);
    welcome.missingAssets = in.at("missing_assets").texts(kListCount, 64);
    welcome.heartbeatS = in.at("heartbeat_s").u32(1, 3600);
    return welcome;
}

ServerMessage decodeOk(Fields& in) {
    Ok ok{requestId(in)};
    if (const auto v = in.find("rev")) ok.rev = v->u32();
    if (const auto v = in.find("credit"))
        ok.offer =
            AssetOffer{in.at("asset").u32(), in.at("have").integer(0, kMaxSafeInteger), v->integer(0, kMaxSafeInteger)};
    if (const auto v = in.find("sha256"))
        ok.report = AssetReport{v->sha256(), in.at("meshes").u32(), in.at("vertices").u32(), in.at("triangles").u32(),
                                in.at("warnings").texts(kListCount, kSentenceBytes)};
    if (const auto v = in.find("recording")) ok.recording = v->text(kNameBytes, 1);
    if (const auto v = in.find("frame_seq")) ok.frame = FrameReply{v->u32(1), in.at("map_hash").text(16, 16)};
    return ok;
}

ServerMessage decodeError(Fields& in) {
    ErrorMessage error;
    if (const auto v = in.find("id")) error.id = v->u32(1);
    const Item name = in.at("code");
    if (const auto code = errorCodeOf(name.text(64)))
        error.code = *code;
    else
        name.fail(ErrorCode::Unsupported, "is not a known error");
    error.message = in.at("message").text(kSentenceBytes);
    if (const auto v = in.find("field")) error.field = v->text(kSentenceBytes);
    error.fatal = in.at("fatal").boolean();
    if (const auto v = in.find("retry_ms")) error.retryMs = v->u32();
    return error;
}

ServerMessage decodeStateMessage(Fields& in) {
    return StateMessage{in.at("rev").u32(), in.at("state").object(), decodeSceneSummary(in.at("scene"))};
}

ServerMessage decodeStreamInfo(Fields& in) {
    StreamInfo info;
    info.epoch = static_cast<std::uint16_t>(in.at("epoch").u32(0, 65535));
    decodeTarget(in.at("target"), info.target, info.pass);
    info.encoding = in.at("encoding").oneOf(kEncodings);
    info.sample = in.at("sample").oneOf(kSamples);
    info.layout = in.at("layout").oneOf(kLayouts);
    info.width = in.at("width").u32(1, 65535);
    info.height = in.at("height").u32(1, 65535);
    info.bands = in.at("bands").u32(1, 65535);
    info.wavelengthsNm = in.at("wavelengths_nm").ascending(0, kListCount, 100, 10000);
    const Item matrix = in.at("light_matrix");
    const std::size_t count = matrix.size(16, 16);
    for (std::size_t i = 0; i < count; ++i) info.lightMatrix[i] = matrix[i].number(-kAnyNumber, kAnyNumber);
    info.unit = in.at("unit").text(kNameBytes);
    return info;
}

ServerMessage decodeAssetCredit(Fields& in) {
    return AssetCredit{in.at("asset").u32(), in.at("have").integer(0, kMaxSafeInteger),
                       in.at("credit").integer(0, kMaxSafeInteger)};
}

ServerMessage decodePong(Fields& in) {
    return Pong{in.at("t_us").integer(0, kMaxSafeInteger), in.at("server_us").integer(0, kMaxSafeInteger)};
}

ServerMessage decodeStatus(Fields& in) {
    return Status{in.at("level").oneOf(kLevels), in.at("key").text(kNameBytes, 1),
                  in.at("message").text(kSentenceBytes)};
}

StageTime decodeStage(const Item& item) {
    Fields in(item);
    StageTime stage{in.at("pass").text(kNameBytes), in.at("ms").number(0, kAnyNumber)};
    in.finish();
    return stage;
}

std::string decodeSentence(const Item& item) { return item.text(kSentenceBytes); }

PlanEntry decodePlanEntry(const Item& item) {
    Fields in(item);
    PlanEntry entry{in.at("pass").text(kNameBytes), in.at("run").boolean(), in.at("reason").text(kSentenceBytes), {}};
    if (const auto v = in.find("without")) entry.without = decodeList(*v, decodeSentence);
    in.finish();
    return entry;
}

ErrorEstimate decodeErrorEstimate(const Item& item) {
    Fields in(item);
    ErrorEstimate error{in.at("sampling").number(0, kAnyNumber), in.at("spectral").number(0, kAnyNumber),
                        in.at("total").number(0, kAnyNumber)};
    in.finish();
    return error;
}

Convergence decodeConvergence(const Item& item) {
    Fields in(item);
    Convergence convergence;
    convergence.photons = in.at("photons").integer(0, kMaxSafeInteger);
    convergence.error = in.at("error").number(0, kAnyNumber);
    convergence.target = in.at("target").number(0, kAnyNumber);
    convergence.progress = in.at("progress").number(0, 1);
    convergence.converged = in.at("converged").boolean();
    in.finish();
    return convergence;
}

Json toJson(const Convergence& convergence) {
    return {{"photons", convergence.photons},
            {"error", convergence.error},
            {"target", convergence.target},
            {"progress", convergence.progress},
            {"converged", convergence.converged}};
}

Drops decodeDrops(const Item& item) {
    Fields in(item);
    Drops drops{in.at("replaced").u32(), in.at("outdated").u32()};
    in.finish();
    return drops;
}

ServerMessage decodeStats(Fields& in) {
    Stats stats;
    stats.frameSeq = in.at("frame_seq").u32();
    stats.stages = decodeList(in.at("stages"), decodeStage);
    stats.plan = decodeList(in.at("plan"), decodePlanEntry);
    if (const auto v = in.find("ledger")) stats.ledger = decodeLedger(*v);
    if (const auto v = in.find("error")) stats.error = decodeErrorEstimate(*v);
    if (const auto v = in.find("convergence")) stats.convergence = decodeConvergence(*v);
    if (const auto v = in.find("choice")) stats.choice = v->text(kSentenceBytes);
    stats.photons = in.at("photons").u32();
    stats.renderMs = in.at("render_ms").number(0, kAnyNumber);
    stats.encodeMs = in.at("encode_ms").number(0, kAnyNumber);
    stats.window = in.at("window").u32();
    stats.dropped = in.at("dropped").u32();
    stats.rttMs = in.at("rtt_ms").number(0, kAnyNumber);
    // A server of before these were sent leaves them out.
    if (const auto v = in.find("base_rtt_ms")) stats.baseRttMs = v->number(0, kAnyNumber);
    if (const auto v = in.find("hold_ms")) stats.holdMs = v->number(0, kAnyNumber);
    if (const auto v = in.find("send_ms")) stats.sendMs = v->number(0, kAnyNumber);
    if (const auto v = in.find("age_ms")) stats.ageMs = v->number(0, kAnyNumber);
    if (const auto v = in.find("level")) stats.level = v->u32(0, 255);
    if (const auto v = in.find("drops")) stats.drops = decodeDrops(*v);
    stats.exposureEv = in.at("exposure_ev").number(-kAnyNumber, kAnyNumber);
    stats.warnings = in.at("warnings").texts(kListCount, kSentenceBytes);
    return stats;
}

ServerMessage decodeGoaway(Fields& in) {
    return Goaway{in.at("reason").oneOf(kReasons), in.at("reconnect_ms").u32(), in.at("jitter_ms").u32()};
}

constexpr Op<ServerMessage> kOps[] = {
    {"welcome", decodeWelcome},
    {"ok", decodeOk},
    {"error", decodeError},
    {"state", decodeStateMessage},
    {"stream.info", decodeStreamInfo},
    {"asset.credit", decodeAssetCredit},
    {"pong", decodePong},
    {"status", decodeStatus},
    {"stats", decodeStats},
    {"goaway", decodeGoaway},
};

}  // namespace

tl::expected<ServerMessage, DecodeError> decodeServerMessage(std::string_view text, const Limits& limits, bool strict) {
    return decodeByOp<ServerMessage>(text, limits.serverTextBytes, limits.depth, strict, kOps);
}

ErrorMessage errorMessage(const DecodeError& error, bool fatal) {
    ErrorMessage message{error.id, error.code, error.message, std::nullopt, fatal, std::nullopt};
    if (!error.field.empty()) message.field = error.field;
    return message;
}

std::string encode(const Welcome& welcome) {
    Json glasses = Json::array();
    for (const GlassPreset& glass : welcome.glasses)
        glasses.push_back({{"name", glass.name}, {"dispersion", toJson(glass.dispersion)}});
    return text({{"op", "welcome"},
                 {"id", welcome.id},
                 {"session", welcome.session},
                 {"view_id", welcome.viewId},
                 {"server", welcome.server},
                 {"protocol", welcome.protocol},
                 {"build", welcome.build},
                 {"gpu", welcome.gpu},
                 {"resumed", welcome.resumed},
                 {"rev", welcome.rev},
                 {"state", welcome.state},
                 {"caps", welcome.caps},
                 {"scenes", welcome.scenes},
                 {"passes", welcome.passes},
                 {"limits", toJson(welcome.limits)},
                 {"glasses", std::move(glasses)},
                 {"missing_assets", welcome.missingAssets},
                 {"heartbeat_s", welcome.heartbeatS}});
}

std::string encode(const Ok& ok) {
    Json json = {{"op", "ok"}, {"id", ok.id}};
    putOptional(json, "rev", ok.rev);
    if (ok.offer) json.update({{"asset", ok.offer->asset}, {"have", ok.offer->have}, {"credit", ok.offer->credit}});
    if (ok.report)
        json.update({{"sha256", ok.report->sha256},
                     {"meshes", ok.report->meshes},
                     {"vertices", ok.report->vertices},
                     {"triangles", ok.report->triangles},
                     {"warnings", ok.report->warnings}});
    putOptional(json, "recording", ok.recording);
    if (ok.frame) json.update({{"frame_seq", ok.frame->frameSeq}, {"map_hash", ok.frame->mapHash}});
    return text(json);
}

std::string encode(const ErrorMessage& error) {
    Json json = {{"op", "error"}, {"code", errorName(error.code)}, {"message", error.message}, {"fatal", error.fatal}};
    putOptional(json, "id", error.id);
    putOptional(json, "field", error.field);
    putOptional(json, "retry_ms", error.retryMs);
    return text(json);
}

std::string encode(const StateMessage& state) {
    return text({{"op", "state"}, {"rev", state.rev}, {"state", state.state}, {"scene", toJson(state.scene)}});
}

std::string encode(const StreamInfo& info) {
    return text({{"op", "stream.info"},
                 {"epoch", info.epoch},
                 {"target", targetName(info.target, info.pass)},
                 {"encoding", nameOf(kEncodings, info.encoding)},
                 {"sample", nameOf(kSamples, info.sample)},
                 {"layout", nameOf(kLayouts, info.layout)},
                 {"width", info.width},
                 {"height", info.height},
                 {"bands", info.bands},
                 {"wavelengths_nm", info.wavelengthsNm},
                 {"light_matrix", info.lightMatrix},
                 {"unit", info.unit}});
}

std::string encode(const AssetCredit& credit) {
    return text({{"op", "asset.credit"}, {"asset", credit.asset}, {"have", credit.have}, {"credit", credit.credit}});
}

std::string encode(const Pong& pong) {
    return text({{"op", "pong"}, {"t_us", pong.tUs}, {"server_us", pong.serverUs}});
}

std::string encode(const Status& status) {
    return text(
        {{"op", "status"}, {"level", nameOf(kLevels, status.level)}, {"key", status.key}, {"message", status.message}});
}

std::string encode(const Stats& stats) {
    Json stages = Json::array(), plan = Json::array();
    for (const StageTime& stage : stats.stages) stages.push_back({{"pass", stage.pass}, {"ms", stage.ms}});
    for (const PlanEntry& entry : stats.plan) {
        plan.push_back({{"pass", entry.pass}, {"run", entry.run}, {"reason", entry.reason}});
        if (!entry.without.empty()) plan.back()["without"] = entry.without;
    }
    Json json = {{"op", "stats"},
                 {"frame_seq", stats.frameSeq},
                 {"stages", std::move(stages)},
                 {"plan", std::move(plan)},
                 {"photons", stats.photons},
                 {"render_ms", stats.renderMs},
                 {"encode_ms", stats.encodeMs},
                 {"window", stats.window},
                 {"dropped", stats.dropped},
                 {"rtt_ms", stats.rttMs},
                 {"base_rtt_ms", stats.baseRttMs},
                 {"hold_ms", stats.holdMs},
                 {"send_ms", stats.sendMs},
                 {"age_ms", stats.ageMs},
                 {"level", stats.level},
                 {"drops", {{"replaced", stats.drops.replaced}, {"outdated", stats.drops.outdated}}},
                 {"exposure_ev", stats.exposureEv},
                 {"warnings", stats.warnings}};
    if (stats.ledger) json["ledger"] = toJson(*stats.ledger);
    if (stats.error)
        json["error"] = {{"sampling", stats.error->sampling}, {"spectral", stats.error->spectral}, {"total", stats.error->total}};
    if (stats.convergence) json["convergence"] = toJson(*stats.convergence);
    if (!stats.choice.empty()) json["choice"] = stats.choice;
    return text(json);
}

std::string encode(const Goaway& goaway) {
    return text({{"op", "goaway"},
                 {"reason", nameOf(kReasons, goaway.reason)},
                 {"reconnect_ms", goaway.reconnectMs},
                 {"jitter_ms", goaway.jitterMs}});
}

std::string encode(const ServerMessage& message) {
    return std::visit([](const auto& one) { return encode(one); }, message);
}

}  // namespace caustream::protocol
