#include "resolve_request.h"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <string>
#include <utility>

#include "render/pipeline.h"
#include "session/scene_overrides.h"

namespace caustream {
namespace {

using protocol::Encoding;
using protocol::ErrorCode;
using protocol::Sample;
using protocol::Target;


tl::unexpected<protocol::DecodeError> unsupported(std::string message, std::string field) {
    return tl::unexpected(
        protocol::DecodeError{.code = ErrorCode::Unsupported, .message = std::move(message), .field = std::move(field)});
}

std::string passList() {
    std::string names;
    for (const std::string& name : render::passNames()) {
        names += (names.empty() ? "" : ", ") + name;
    }
    return names;
}

// What the protocol lets through and this server does not have.
tl::expected<void, protocol::DecodeError> checkStream(const protocol::StreamState& stream) {
    if (stream.target == Target::Pass && std::ranges::find(render::passNames(), stream.pass) == render::passNames().end()) {
        return unsupported("there is no pass '" + stream.pass + "' to show; there are: " + passList(), "stream.target");
    }
    if (stream.target != Target::Spectral && stream.sample == Sample::F16) {
        return unsupported("a picture has u8 or f32 samples", "stream.sample");
    }
    return {};
}

Sample sampleOf(const render::Frame& frame) {
    switch (frame.sample) {
        case render::Sample::U8: return Sample::U8;
        case render::Sample::F16: return Sample::F16;
        case render::Sample::F32: break;
    }
    return Sample::F32;
}

render::Mode modeOf(protocol::TransportMode wanted) {
    switch (wanted) {
        case protocol::TransportMode::Auto: return render::Mode::Auto;
        case protocol::TransportMode::Traced: return render::Mode::Traced;
        case protocol::TransportMode::Refined: return render::Mode::Refined;
        case protocol::TransportMode::Thesis: break;
    }
    return render::Mode::Thesis;
}

render::Transport transportOf(const protocol::TransportState& wanted) {
    return {.mode = modeOf(wanted.mode),
            .wavelengths = wanted.wavelengths,
            .wavelengthsNm = wanted.wavelengthsNm,
            .photonGrid = wanted.photonGrid,
            .mapSize = wanted.mapSize,
            .backSteps = wanted.backSteps,
            .receiverSteps = wanted.receiverSteps,
            .gapFill = wanted.gapFill,
            .filter = wanted.filter,
            .forceDispersive = wanted.forceDispersive,
            .hierarchyLevels = wanted.hierarchyLevels,
            .bounces = wanted.bounces,
            .exactReceivers = wanted.exactReceivers,
            .budgetMs = wanted.budgetMs,
            .targetError = wanted.targetError};
}

}  // namespace

tl::expected<View, protocol::DecodeError> resolveRequest(const protocol::State& state,
                                                         std::shared_ptr<const scene::Scene> scene, bool readsPng) {
    const protocol::StreamState& stream = state.stream;
    if (auto checked = checkStream(stream); !checked) {
        return tl::unexpected(std::move(checked.error()));
    }
    auto camera = session::cameraOf(*scene, state);
    if (!camera) {
        return tl::unexpected(std::move(camera.error()));
    }
    View view;
    view.stream = stream;
    view.encode = {.encoding = stream.encoding, .jpegQuality = stream.jpegQuality.value_or(stream::Ladder::at(stream::Ladder::kBest).jpegQuality)};
    view.encodeLast = view.encode;
    view.adaptive = stream.encoding == Encoding::Jpeg && !stream.jpegQuality && stream.target != Target::Spectral;
    if (stream.encoding == Encoding::Jpeg && readsPng) {
        view.encodeLast.encoding = Encoding::Png;
    }
    render::Request& request = view.request;
    request.scene = std::move(scene);
    request.camera = std::move(*camera);
    if (state.camera.exposureEv) {
        request.exposureEv = static_cast<float>(*state.camera.exposureEv);
    }
    request.transport = transportOf(state.transport);
    request.target = stream.target == Target::Composite  ? render::Target::Composite
                     : stream.target == Target::Spectral ? render::Target::Spectral
                                                         : render::Target::Pass;
    request.pass = stream.pass;
    request.sample = stream.sample == Sample::U8    ? render::Sample::U8
                     : stream.sample == Sample::F16 ? render::Sample::F16
                                                    : render::Sample::F32;
    request.wavelengthBands = stream.wavelengthBands;
    request.width = stream.width;
    request.height = stream.height;
    return view;
}

std::size_t estimatedBytes(const View& view) {
    // Geometry lies in memory, on the GPU and in two trees; a map in fixed point, in floats and around itself; a picture in
    // half and full floats, at four times its size for a still, and in what is read back.
    constexpr std::size_t kPerMapTexel = 48, kPerPixel = 104, kPerPhoton = 64, kPerBandTexel = 8;
    const scene::Geometry& geometry = *view.request.scene->geometry;
    std::size_t bytes = 5 * (geometry.vertices.size() * sizeof(scene::Vertex) + geometry.indices.size() * sizeof(std::uint32_t));
    for (const scene::Texture& texture : geometry.textures) {
        bytes += 3 * texture.rgba.size();
    }
    const render::Transport& transport = view.request.transport;
    const auto square = [](int side) { return static_cast<std::size_t>(side) * static_cast<std::size_t>(side); };
    const std::size_t bands = view.request.wavelengthBands ? std::max<std::size_t>(transport.wavelengthsNm.size(), transport.wavelengths) : 0;
    bytes += square(transport.mapSize) * (kPerMapTexel + bands * kPerBandTexel) + square(transport.photonGrid) * kPerPhoton;
    return bytes + static_cast<std::size_t>(view.request.width) * static_cast<std::size_t>(view.request.height) * kPerPixel;
}

stream::Ladder::Size shownSize(const View& view, const render::Frame& frame) {
    return view.stream.target == Target::Spectral ? stream::Ladder::Size{frame.width, frame.height}
                                                  : stream::Ladder::Size{view.request.width, view.request.height};
}

protocol::StreamInfo streamInfo(const View& view, const render::Frame& frame, Encoding encoding) {
    protocol::StreamInfo info;
    info.target = view.stream.target;
    info.pass = view.stream.pass;
    info.encoding = encoding;
    info.sample = sampleOf(frame);
    info.layout = stream::layoutOf(encoding, info.sample);
    const stream::Ladder::Size size = shownSize(view, frame);
    info.width = static_cast<std::uint32_t>(size.width);
    info.height = static_cast<std::uint32_t>(size.height);
    info.bands = static_cast<std::uint32_t>(frame.bands);
    info.wavelengthsNm = frame.wavelengthsNm;
    std::copy_n(glm::value_ptr(frame.lightMatrix), info.lightMatrix.size(), info.lightMatrix.begin());
    info.unit = view.stream.target == Target::Spectral ? "concentration"
                : frame.sample == render::Sample::U8   ? "sRGB"
                : view.stream.pass == "depth"          ? "m"
                : view.stream.pass == "normals"        ? "normal"
                : view.stream.pass == "caster_mask"    ? "caster"
                                                       : "linear";
    return info;
}

protocol::FrameHeader frameHeader(const View& view, const render::Frame& frame, const stream::EncodeSettings& encode, int level) {
    protocol::FrameHeader header;
    header.target = view.stream.target;
    header.encoding = encode.encoding;
    header.level = static_cast<std::uint8_t>(level);
    header.sample = sampleOf(frame);
    header.layout = stream::layoutOf(header.encoding, header.sample);
    header.width = static_cast<std::uint16_t>(frame.width);
    header.height = static_cast<std::uint16_t>(frame.height);
    const stream::Ladder::Size size = shownSize(view, frame);
    header.viewWidth = static_cast<std::uint16_t>(size.width);
    header.viewHeight = static_cast<std::uint16_t>(size.height);
    if (frame.width < size.width || frame.height < size.height) {
        header.flags |= protocol::kFrameScaled;
    }
    header.bands = static_cast<std::uint16_t>(frame.bands);
    if (encode.encoding == Encoding::Jpeg) {
        header.jpegQuality = static_cast<std::uint8_t>(encode.jpegQuality);
    }
    header.renderUs = static_cast<std::uint32_t>(frame.stats.renderMs * 1e3);
    header.rawLen = static_cast<std::uint32_t>(static_cast<std::size_t>(frame.width) * frame.height * frame.bands * protocol::sampleBytes(header.sample));
    return header;
}

protocol::Stats frameStats(const render::Frame& frame) {
    protocol::Stats stats;
    for (const render::StageTime& stage : frame.stats.stages) {
        stats.stages.push_back({stage.pass, stage.ms});
    }
    for (const render::PlanEntry& entry : frame.stats.plan) {
        stats.plan.push_back({entry.pass, entry.run, entry.reason, entry.without});
    }
    const render::EnergyLedger& ledger = frame.stats.ledger;
    if (ledger.onCasters != 0.0) {
        stats.ledger = protocol::Ledger{ledger.onCasters,       ledger.deposited, ledger.absorbed, ledger.reflected,
                                        ledger.totalReflection, ledger.rejected,  ledger.leftMap,  ledger.noReceiver,
                                        ledger.cut};
    }
    if (const auto& error = frame.stats.error) stats.error = {error->sampling, error->spectral, error->total};
    if (const auto& convergence = frame.stats.convergence) {
        stats.convergence = {convergence->photons, convergence->error, convergence->target, convergence->progress,
                             convergence->converged};
    }
    stats.choice = frame.stats.choice;
    stats.photons = frame.stats.photons;
    stats.renderMs = frame.stats.renderMs;
    stats.exposureEv = frame.stats.exposureEv;
    stats.warnings = frame.stats.warnings;
    return stats;
}

}  // namespace caustream
