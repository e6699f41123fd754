// What a server says. One struct per op.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <variant>
#include <vector>

#include "protocol/frame_header.h"
#include "protocol/state.h"

namespace caustream::protocol {

struct GlassPreset {
    std::string name;
    Dispersion dispersion;
    bool operator==(const GlassPreset&) const = default;
};

struct Welcome {
    std::uint32_t id = 0;  // of the hello
    std::string session;
    std::string viewId;  // what others name in hello.follow; empty: this server lets no one follow
    std::string server;  // this server's id, for ?srv=
    std::string protocol = "caustream.v1";
    std::string build;
    std::string gpu;  // the renderer's name
    bool resumed = false;
    std::uint32_t rev = 0;  // of `state`
    Json state = Json::object();
    std::vector<std::string> caps, scenes, passes;
    Limits limits;
    std::vector<GlassPreset> glasses;
    std::vector<std::string> missingAssets;  // SHA-256 of what the resumed state names and this server lacks
    std::uint32_t heartbeatS = 15;
    bool operator==(const Welcome&) const = default;
};

struct AssetOffer {            // answers asset.begin
    std::uint32_t asset = 0;   // this connection's number for it
    std::uint64_t have = 0;    // bytes the server already holds: go on from there
    std::uint64_t credit = 0;  // bytes that may be sent beyond `have`
    bool operator==(const AssetOffer&) const = default;
};
struct AssetReport {  // answers asset.end
    std::string sha256;
    std::uint32_t meshes = 0, vertices = 0, triangles = 0;
    std::vector<std::string> warnings;
    bool operator==(const AssetReport&) const = default;
};
struct FrameReply {  // answers frame.request, just before the frame
    std::uint32_t frameSeq = 0;
    std::string mapHash;  // 16 hex digits
    bool operator==(const FrameReply&) const = default;
};

struct Ok {
    std::uint32_t id = 0;
    std::optional<std::uint32_t> rev;  // answers update
    std::optional<AssetOffer> offer;
    std::optional<AssetReport> report;
    std::optional<FrameReply> frame;
    std::optional<std::string> recording;  // answers record: the file's name on the server
    bool operator==(const Ok&) const = default;
};

struct ErrorMessage {
    std::optional<std::uint32_t> id;
    ErrorCode code = ErrorCode::BadRequest;
    std::string message;
    std::optional<std::string> field;
    bool fatal = false;  // the connection closes after this
    std::optional<std::uint32_t> retryMs;
    bool operator==(const ErrorMessage&) const = default;
};
ErrorMessage errorMessage(const DecodeError& error, bool fatal = false);

struct Box {  // m
    Vec3 min{}, max{};
    bool operator==(const Box&) const = default;
};
struct MaterialSummary {
    std::string name;
    bool caster = false;
    bool operator==(const MaterialSummary&) const = default;
};
struct LightSummary {
    std::string name;
    LightType type = LightType::Spot;
    bool operator==(const LightSummary&) const = default;
};
struct CameraSummary {
    std::string name;
    Vec3 eye{}, target{}, up{0, 1, 0};
    double fovYDeg = 40.0;
    bool operator==(const CameraSummary&) const = default;
};
struct SceneSummary {
    std::string name;
    std::optional<Box> bounds, casterBounds;  // nothing: empty
    std::uint32_t triangles = 0;
    std::vector<std::string> casters, receivers;  // objects
    std::vector<MaterialSummary> materials;
    std::vector<LightSummary> lights;
    std::vector<CameraSummary> cameras;
    std::vector<std::string> warnings;
    bool operator==(const SceneSummary&) const = default;
};

struct StateMessage {  // after every scene change
    std::uint32_t rev = 0;
    Json state = Json::object();  // resolved: the file's values where nothing overrides them
    SceneSummary scene;
    bool operator==(const StateMessage&) const = default;
};

struct StreamInfo {  // before an epoch's first frame
    std::uint16_t epoch = 0;
    Target target = Target::Composite;
    std::string pass;  // Target::Pass only
    Encoding encoding = Encoding::Jpeg;
    Sample sample = Sample::U8;
    Layout layout = Layout::Interleaved;
    std::uint32_t width = 0, height = 0, bands = 3;
    std::vector<double> wavelengthsNm;
    std::array<double, 16> lightMatrix{};  // column-major, world -> map clip space
    std::string unit;                      // "sRGB", "linear", "concentration", "m", "normal", "caster"
    bool operator==(const StreamInfo&) const = default;
};

struct AssetCredit {
    std::uint32_t asset = 0;
    std::uint64_t have = 0, credit = 0;  // as in AssetOffer
    bool operator==(const AssetCredit&) const = default;
};

struct Pong {
    std::uint64_t tUs = 0, serverUs = 0;
    bool operator==(const Pong&) const = default;
};

struct Status {
    enum class Level { Info, Warning, Error };
    Level level = Level::Info;
    std::string key, message;  // a later status of the same key replaces the earlier
    bool operator==(const Status&) const = default;
};

struct StageTime {
    std::string pass;
    double ms = 0.0;
    bool operator==(const StageTime&) const = default;
};
struct PlanEntry {
    std::string pass;
    bool run = false;
    std::string reason;
    std::vector<std::string> without;  // of a pass that runs: the parts of it that this frame does not need, and why
    bool operator==(const PlanEntry&) const = default;
};
struct Ledger {  // flux over the flux per steradian on the light's axis: sr (m^2 for a directional light)
    double onCasters = 0, deposited = 0, absorbed = 0, reflected = 0, totalReflection = 0, rejected = 0, leftMap = 0,
           noReceiver = 0;
    double cut = 0;  // of a traced map: paths that were given up, too faint or with more bounces than asked for
    bool operator==(const Ledger&) const = default;
};
struct ErrorEstimate {  // of the spectral map: relative L1 of luminance
    double sampling = 0.0, spectral = 0.0, total = 0.0;
    bool operator==(const ErrorEstimate&) const = default;
};
struct Convergence {  // of a traced map, or of one that would be traced if nothing moved
    std::uint64_t photons = 0;  // in the map so far
    double error = 1.0;         // estimated, relative L1 of luminance
    double target = 0.01;       // where it ends
    double progress = 0.0;      // share of the photons that it will take, 0..1
    bool converged = false;     // more frames of the same state would not differ by more than the target
    bool operator==(const Convergence&) const = default;
};
struct Drops {  // frames drawn and never sent, by cause
    std::uint32_t replaced = 0;  // by a newer one, before the socket took them
    std::uint32_t outdated = 0;  // drawn at rest, and then something moved
    bool operator==(const Drops&) const = default;
};
struct Stats {  // of the newest frame
    std::uint32_t frameSeq = 0;
    std::vector<StageTime> stages;
    std::vector<PlanEntry> plan;
    std::optional<Ledger> ledger;  // nothing: not counted for this frame
    std::optional<ErrorEstimate> error;  // nothing: no map, or one whose transport cannot tell
    std::optional<Convergence> convergence;  // nothing: the map is as good as it gets in one frame
    std::string choice;                  // what budget_ms or target_error chose, and why; empty: not asked
    std::uint32_t photons = 0;
    double renderMs = 0.0, encodeMs = 0.0;
    std::uint32_t window = 0, dropped = 0;  // acknowledgement window; frames replaced before they were sent
    double rttMs = 0.0;                     // 0: not known yet
    double baseRttMs = 0.0;                 // the least of the last 30 s; 0: not known yet
    double holdMs = 0.0, sendMs = 0.0;      // change -> its drawing begins; encoded -> handed to the socket
    double ageMs = 0.0;                     // newest acknowledged frame: from the change it shows; 0: not known yet
    std::uint32_t level = 255;              // of the quality ladder, 0 the best; 255: fixed
    Drops drops;
    double exposureEv = 0.0;                // the one used
    std::vector<std::string> warnings;
    bool operator==(const Stats&) const = default;
};

struct Goaway {
    enum class Reason { Drain, Shutdown, Takeover };
    Reason reason = Reason::Drain;
    std::uint32_t reconnectMs = 0, jitterMs = 0;  // wait reconnectMs plus a random part of jitterMs
    bool operator==(const Goaway&) const = default;
};

using ServerMessage =
    std::variant<Welcome, Ok, ErrorMessage, StateMessage, StreamInfo, AssetCredit, Pong, Status, Stats, Goaway>;

// Never throws. Unknown fields are ignored.
tl::expected<ServerMessage, DecodeError> decodeServerMessage(std::string_view text, const Limits& limits = {},
                                                             bool strict = false);

std::string encode(const Welcome& message);
std::string encode(const Ok& message);
std::string encode(const ErrorMessage& message);
std::string encode(const StateMessage& message);
std::string encode(const StreamInfo& message);
std::string encode(const AssetCredit& message);
std::string encode(const Pong& message);
std::string encode(const Status& message);
std::string encode(const Stats& message);
std::string encode(const Goaway& message);
std::string encode(const ServerMessage& message);

}  // namespace caustream::protocol
