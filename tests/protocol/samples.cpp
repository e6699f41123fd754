#include "samples.h"

namespace caustream::protocol {
namespace {

const std::string kHash(64, 'a');

Hello fullHello() {
    Hello hello;
    hello.id = 1;
    hello.token = "secret";
    hello.clientName = "caustream-shot";
    hello.clientVersion = "0.1.0";
    hello.caps = {"jpeg", "raw"};
    hello.maxInflight = 8;
    hello.strict = true;
    hello.role = Role::View;
    hello.follow = "s1";
    hello.resume = Resume{"s0", Json{{"scene", {"builtin", "gem"}}}, 7, 9};
    return hello;
}

Welcome fullWelcome() {
    Welcome welcome;
    welcome.id = 1;
    welcome.session = "s1";
    welcome.viewId = "v1";
    welcome.server = "a";
    welcome.build = "0.1.0";
    welcome.gpu = "llvmpipe";
    welcome.resumed = true;
    welcome.rev = 3;
    welcome.state = Json{{"outside_index", 1.5}};
    welcome.caps = {"jpeg"};
    welcome.scenes = {"gem", "prism"};
    welcome.passes = {"photon_list"};
    welcome.glasses = {{"BK7", Cauchy{1.5046, 0.0042, 0.0}}, {"flint", Abbe{1.62, 36.0}}};
    welcome.missingAssets = {kHash};
    return welcome;
}

StateMessage fullStateMessage() {
    StateMessage state;
    state.rev = 4;
    state.state = Json{{"camera", {{"fov_y_deg", 40.0}}}};
    state.scene.name = "gem";
    state.scene.bounds = Box{{-1, 0, -1}, {1, 2, 1}};
    state.scene.casterBounds = Box{{0, 0, 0}, {0.5, 1, 0.5}};
    state.scene.triangles = 96;
    state.scene.casters = {"gem"};
    state.scene.receivers = {"floor"};
    state.scene.materials = {{"diamond", true}, {"oak", false}};
    state.scene.lights = {{"key", LightType::Point}};
    state.scene.cameras = {{"camera", {0, 1, 3}, {0, 0, 0}, {0, 1, 0}, 40.0}};
    state.scene.warnings = {"no normals"};
    return state;
}

StreamInfo fullStreamInfo() {
    StreamInfo info;
    info.epoch = 65535;
    info.target = Target::Spectral;
    info.encoding = Encoding::Raw;
    info.sample = Sample::F16;
    info.layout = Layout::Planar;
    info.width = info.height = 512;
    info.bands = 2;
    info.wavelengthsNm = {450.5, 600};
    for (std::size_t i = 0; i < 16; ++i) info.lightMatrix[i] = double(i) / 4;
    info.unit = "concentration";
    return info;
}

Stats fullStats() {
    Stats stats;
    stats.frameSeq = 12;
    stats.stages = {{"photon_trace", 3.5}};
    stats.plan = {{"photon_trace", true, "the light moved", {"absorption: none"}}, {"gap_fill", false, "not asked for", {}}};
    stats.ledger = Ledger{8, 7, 0.25, 0.5, 0.125, 0.0625, 0.03125, 2, 0.015625};
    stats.error = ErrorEstimate{0.03125, 0.0625, 0.125};
    stats.convergence = Convergence{9007199254740991, 0.0625, 0.015625, 0.25, true};
    stats.choice = "grid 256: the most that 16 ms allow";
    stats.photons = 25000;
    stats.renderMs = 30.5;
    stats.encodeMs = 2.25;
    stats.window = 2;
    stats.dropped = 1;
    stats.rttMs = 4.5;
    stats.baseRttMs = 1.5;
    stats.holdMs = 0.5;
    stats.sendMs = 0.25;
    stats.ageMs = 60.5;
    stats.level = 3;
    stats.drops = {1, 2};
    stats.exposureEv = -1.5;
    stats.warnings = {"two lights"};
    return stats;
}

}  // namespace

const std::vector<MessageSample<ClientMessage>>& clientSamples() {
    static const std::vector<MessageSample<ClientMessage>> samples = {
        {fullHello(),
         R"({"caps":["jpeg","raw"],"client":{"name":"caustream-shot","version":"0.1.0"},"follow":"s1","id":1,)"
         R"("max_inflight":8,"op":"hello","resume":{"input_seq":9,"rev":7,"session":"s0",)"
         R"("state":{"scene":["builtin","gem"]}},"role":"view","strict":true,"token":"secret"})"},
        {Update{2, Json{{"camera", nullptr}}}, R"({"id":2,"op":"update","patch":{"camera":null}})"},
        {Update{{}, Json::object()}, R"({"op":"update","patch":{}})"},
        {Input{4, 9007199254740991, Json{{"camera", {{"eye", {1, 2, 3}}}}, {"lights", Json::object()}}},
         R"({"camera":{"eye":[1,2,3]},"lights":{},"op":"input","seq":4,"t_us":9007199254740991})"},
        {StreamStart{5, true}, R"({"id":5,"op":"stream.start","stats":true})"},
        {StreamPause{6}, R"({"id":6,"op":"stream.pause"})"},
        {StreamResume{4294967295}, R"({"id":4294967295,"op":"stream.resume"})"},
        {FrameRequest{8, true, true}, R"({"converge":true,"id":8,"op":"frame.request","still":true})"},
        {Ack{9, 123456789012, 1500, 700},
         R"({"decode_us":1500,"op":"ack","paint_us":700,"recv_us":123456789012,"seq":9})"},
        {AssetBegin{10, kHash, 67108864, "model/gltf-binary"},
         R"({"id":10,"mime":"model/gltf-binary","op":"asset.begin","sha256":")" + kHash + R"(","size":67108864})"},
        {AssetEnd{11, 3}, R"({"asset":3,"id":11,"op":"asset.end"})"},
        {AssetAbort{3}, R"({"asset":3,"op":"asset.abort"})"},
        {Record{12, true}, R"({"id":12,"on":true,"op":"record"})"},
        {Ping{12}, R"({"op":"ping","t_us":12})"},
    };
    return samples;
}

const std::vector<MessageSample<ServerMessage>>& serverSamples() {
    static const std::vector<MessageSample<ServerMessage>> samples = {
        {fullWelcome(),
         R"({"build":"0.1.0","caps":["jpeg"],"glasses":[{"dispersion":["cauchy",1.5046,0.0042],"name":"BK7"},)"
         R"({"dispersion":["abbe",1.62,36.0],"name":"flint"}],"gpu":"llvmpipe","heartbeat_s":15,"id":1,"limits":{)"
         R"("asset_bytes":67108864,"asset_cache_bytes":536870912,"bands":64,"binary_bytes":1048576,"chunk_bytes":262144,"credit_bytes":1048576,)"
         R"("dead_s":30,"depth":32,"frame_max_side":4096,"frame_min_side":16,"frame_payload_bytes":268435456,)"
         R"("frame_pixels":8300000,"gpu_ms_per_s":0,"hello_s":5,"idle_close_s":3600,"idle_pause_s":600,"messages_per_s":300,"ping_s":15,)"
         R"("resume_s":600,"server_text_bytes":4194304,"sessions":8,"state_bytes":32768,"text_bytes":65536,"viewer_bytes":1073741824},)"
         R"("missing_assets":[")" +
             kHash +
             R"("],"op":"welcome","passes":["photon_list"],"protocol":"caustream.v1","resumed":true,"rev":3,)"
             R"("scenes":["gem","prism"],"server":"a","session":"s1","state":{"outside_index":1.5},"view_id":"v1"})"},
        {Ok{2}, R"({"id":2,"op":"ok"})"},
        {Ok{2, 5}, R"({"id":2,"op":"ok","rev":5})"},
        {Ok{3, {}, AssetOffer{1, 262144, 1048576}}, R"({"asset":1,"credit":1048576,"have":262144,"id":3,"op":"ok"})"},
        {Ok{4, {}, {}, AssetReport{kHash, 2, 300, 96, {"flat normals"}}},
         R"({"id":4,"meshes":2,"op":"ok","sha256":")" + kHash +
             R"(","triangles":96,"vertices":300,"warnings":["flat normals"]})"},
        {Ok{6, {}, {}, {}, {}, "s1-1.jsonl"}, R"({"id":6,"op":"ok","recording":"s1-1.jsonl"})"},
        {Ok{5, {}, {}, {}, FrameReply{17, "0123456789abcdef"}},
         R"({"frame_seq":17,"id":5,"map_hash":"0123456789abcdef","op":"ok"})"},
        {ErrorMessage{6, ErrorCode::OutOfRange, "too far", "camera.eye[1]", true, 250},
         R"({"code":"out_of_range","fatal":true,"field":"camera.eye[1]","id":6,"message":"too far","op":"error",)"
         R"("retry_ms":250})"},
        {ErrorMessage{{}, ErrorCode::BadMessage, "not JSON"},
         R"({"code":"bad_message","fatal":false,"message":"not JSON","op":"error"})"},
        {fullStateMessage(),
         R"({"op":"state","rev":4,"scene":{"bounds":{"max":[1.0,2.0,1.0],"min":[-1.0,0.0,-1.0]},)"
         R"("cameras":[{"eye":[0.0,1.0,3.0],"fov_y_deg":40.0,"name":"camera","target":[0.0,0.0,0.0],"up":[0.0,1.0,0.0]}],)"
         R"("caster_bounds":{"max":[0.5,1.0,0.5],"min":[0.0,0.0,0.0]},"casters":["gem"],)"
         R"("lights":[{"name":"key","type":"point"}],"materials":[{"caster":true,"name":"diamond"},)"
         R"({"caster":false,"name":"oak"}],"name":"gem","receivers":["floor"],"triangles":96,"warnings":["no normals"]},)"
         R"("state":{"camera":{"fov_y_deg":40.0}}})"},
        {fullStreamInfo(),
         R"({"bands":2,"encoding":"raw","epoch":65535,"height":512,"layout":"planar","light_matrix":[0.0,0.25,0.5,0.75,)"
         R"(1.0,1.25,1.5,1.75,2.0,2.25,2.5,2.75,3.0,3.25,3.5,3.75],"op":"stream.info","sample":"f16","target":"spectral",)"
         R"("unit":"concentration","wavelengths_nm":[450.5,600.0],"width":512})"},
        {AssetCredit{1, 524288, 1048576}, R"({"asset":1,"credit":1048576,"have":524288,"op":"asset.credit"})"},
        {Pong{12, 34}, R"({"op":"pong","server_us":34,"t_us":12})"},
        {Status{Status::Level::Warning, "gpu", "software rendering"},
         R"({"key":"gpu","level":"warning","message":"software rendering","op":"status"})"},
        {fullStats(),
         R"({"age_ms":60.5,"base_rtt_ms":1.5,"choice":"grid 256: the most that 16 ms allow","convergence":{"converged":true,"error":0.0625,)"
         R"("photons":9007199254740991,"progress":0.25,"target":0.015625},"dropped":1,"drops":{"outdated":2,"replaced":1},"encode_ms":2.25,)"
         R"("error":{"sampling":0.03125,"spectral":0.0625,"total":0.125},"exposure_ev":-1.5,"frame_seq":12,"hold_ms":0.5,"ledger":{"absorbed":0.25,"cut":0.015625,"deposited":7.0,)"
         R"("left_map":0.03125,"no_receiver":2.0,"on_casters":8.0,"reflected":0.5,"rejected":0.0625,)"
         R"("total_reflection":0.125},"level":3,"op":"stats","photons":25000,"plan":[{"pass":"photon_trace",)"
         R"("reason":"the light moved","run":true,"without":["absorption: none"]},{"pass":"gap_fill","reason":"not asked for","run":false}],)"
         R"("render_ms":30.5,"rtt_ms":4.5,"send_ms":0.25,"stages":[{"ms":3.5,"pass":"photon_trace"}],"warnings":["two lights"],"window":2})"},
        {Goaway{Goaway::Reason::Takeover, 100, 50},
         R"({"jitter_ms":50,"op":"goaway","reason":"takeover","reconnect_ms":100})"},
    };
    return samples;
}

State fullState() {
    State state;
    state.scene = {SceneRef::Kind::Asset, kHash};
    LightState& key = state.lights["lamp.001"];
    key.type = LightType::Spot;
    key.position = Vec3{1, 2, 3};
    key.direction = Vec3{0, -1, 0};
    key.halfAngleDeg = 30;
    key.innerAngleDeg = 25;
    key.intensity = Intensity{Intensity::Unit::Watt, 60};
    key.color = Vec3{1, 0.5, 0.25};
    key.spectrum = Lines{{486.1, 589.3, 656.3}};
    key.cookie = Cookie{2};
    state.lights["sun"].type = LightType::Directional;
    state.lights["sun"].spectrum = Blackbody{5800};
    state.lights["sun"].cookie = Cookie{};
    state.lights["daylight"].spectrum = DaylightD65{};
    state.lights["daylight"].type = LightType::Point;
    state.lights["flat"].spectrum = EqualEnergy{};
    state.lights["flat"].intensity = Intensity{Intensity::Unit::Lux, 1000};
    state.materials["water"].dispersion = ConstantIndex{1.333};
    state.materials["silica"].dispersion = Cauchy{1.458, 0.00354, 0.00001};
    state.materials["flint"].dispersion = Abbe{1.62, 36};
    state.materials["BK7"].dispersion =
        Sellmeier{{1.03961212, 0.231792344, 1.01046945}, {0.00600069867, 0.0200179144, 103.560653}};
    state.materials["BK7"].absorption = Absorption{{400, 700}, {0.5, 0.25}};
    state.camera = {Vec3{0, 1, 3}, Vec3{0, 0.5, 0}, Vec3{0, 0, 1}, 35.0, -2.5};
    state.environmentColor = Vec3{0.1, 0.2, 0.3};
    state.outsideIndex = 1.333;
    state.transport = {TransportMode::Traced, kContinuous, {450, 550, 650}, 1024, 1024, 2, 12, true, false, true, 6, 16, true, 16.5, 0.02};
    state.stream = {Target::Pass, "photon_list", Encoding::Png, Sample::U8, true, 640, 480, 85, 30.0};
    return state;
}

}  // namespace caustream::protocol
