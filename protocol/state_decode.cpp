#include <algorithm>
#include <string>

#include "protocol/choices.h"
#include "protocol/frame_header.h"

namespace caustream::protocol {
namespace {

// As wide as what a scene file may hold: the resolved document of every scene that loads must decode.
constexpr double kFarM = 1e9;                // positions, each coordinate
constexpr double kMaxHalfAngleDeg = 90.001;  // files write pi/2 as 1.5708
constexpr std::size_t kMaxNamed = 4096;      // lights, or materials, in one document

LightState decodeLight(const Item& item) {
    Fields in(item);
    LightState light;
    if (const auto v = in.find("type")) light.type = v->oneOf(kLightTypes);
    if (const auto v = in.find("position")) light.position = v->vec3(-kFarM, kFarM);
    if (const auto v = in.find("direction")) light.direction = v->direction();
    if (const auto v = in.find("half_angle_deg")) light.halfAngleDeg = v->number(1e-6, kMaxHalfAngleDeg);
    if (const auto v = in.find("inner_angle_deg")) {
        light.innerAngleDeg = v->number(0, kMaxHalfAngleDeg);
        if (light.halfAngleDeg && *light.innerAngleDeg > *light.halfAngleDeg)
            v->fail(ErrorCode::OutOfRange, "must not be larger than half_angle_deg");
    }
    if (const auto v = in.find("intensity")) light.intensity = decodeIntensity(*v);
    if (const auto v = in.find("color")) light.color = v->vec3(0, 1e6);
    if (const auto v = in.find("spectrum")) light.spectrum = decodeSpectrum(*v);
    if (const auto v = in.find("cookie")) light.cookie = decodeCookie(*v);
    in.finish();
    return light;
}

MaterialState decodeMaterial(const Item& item) {
    Fields in(item);
    MaterialState material;
    if (const auto v = in.find("dispersion")) material.dispersion = decodeDispersion(*v);
    if (const auto v = in.find("absorption")) material.absorption = decodeAbsorption(*v);
    in.finish();
    return material;
}

// {name: value, ...}
template <class T>
std::map<std::string, T> decodeNamed(const Item& item, T (*decodeOne)(const Item&)) {
    std::map<std::string, T> named;
    if (!item.json().is_object()) {
        item.fail(ErrorCode::BadRequest, "must be an object");
        return named;
    }
    if (item.json().size() > kMaxNamed) item.fail(ErrorCode::OutOfRange, "has more than 4096 members");
    for (const auto& [name, value] : item.json().get_ref<const Json::object_t&>()) {
        const Item child(&value, &item, name, 0, item.decoding());
        if (name.empty() || name.size() > kNameBytes)
            item.fail(ErrorCode::OutOfRange, "a name must have 1 to 128 bytes");
        named.emplace(name, decodeOne(child));
    }
    return named;
}

CameraState decodeCamera(const Item& item) {
    Fields in(item);
    CameraState camera;
    if (const auto v = in.find("eye")) camera.eye = v->vec3(-kFarM, kFarM);
    if (const auto v = in.find("target")) {
        camera.target = v->vec3(-kFarM, kFarM);
        if (camera.eye == camera.target) v->fail(ErrorCode::OutOfRange, "must not be where the eye is");
    }
    if (const auto v = in.find("up")) camera.up = v->direction();
    if (const auto v = in.find("fov_y_deg")) camera.fovYDeg = v->number(1, 170);
    if (const auto v = in.find("exposure"); v && v->size(1, 2) > 0) {
        const std::size_t count = (*v)[0].oneOf(kExposures) ? 1 : 2;
        if (v->size(count, count) == 2) camera.exposureEv = (*v)[1].number(-32, 32);
    }
    in.finish();
    return camera;
}

// What the fields of `transport` must be together.
void checkTransport(const Item& item, const TransportState& transport) {
    const auto contradict = [&](const char* field, const char* message) {
        Item(&item.json(), &item, field, 0, item.decoding()).fail(ErrorCode::BadRequest, message);
    };
    const int count = transport.wavelengths;
    const bool published = transport.wavelengthsNm.empty() && (count == kContinuous || count == 1 || count == 7 || count == 21);
    if (transport.mode == TransportMode::Thesis && !published)
        contradict("wavelengths", "mode \"thesis\" has the colours of 1, 7 or 21 wavelengths; \"continuous\" means 7 to it");
    // A traced map takes both: so many photons a frame, and so many frames.
    const bool converges = transport.mode == TransportMode::Auto || transport.mode == TransportMode::Traced;
    if (!converges && transport.budgetMs > 0 && transport.targetError > 0)
        contradict("target_error", "set either this or budget_ms to more than 0; modes \"auto\" and \"traced\" take both");
}

TransportState decodeTransport(const Item& item, const Limits& limits) {
    Fields in(item);
    TransportState transport;
    if (const auto v = in.find("mode")) transport.mode = v->oneOf(kTransportModes);
    if (const auto v = in.find("wavelengths")) {
        if (v->json().is_array())
            transport.wavelengthsNm = v->ascending(1, limits.bands, kBandMinNm, kBandMaxNm);
        else if (v->json() == kContinuousName)
            transport.wavelengths = kContinuous;
        else if (v->json().is_string())
            v->fail(ErrorCode::Unsupported, "must be \"continuous\", a count or an array of nm");
        else
            transport.wavelengths = v->integerInt(1, int(limits.bands));
    }
    if (const auto v = in.find("photon_grid")) {
        transport.photonGrid = v->integerInt(0, 2048);
        if (transport.photonGrid > 0 && transport.photonGrid < 16)
            v->fail(ErrorCode::OutOfRange, "must be 0 (chosen by the server) or 16 to 2048");
    }
    if (const auto v = in.find("map_size")) {
        transport.mapSize = v->integerInt(64, 2048);
        if (transport.mapSize % 16 != 0) v->fail(ErrorCode::OutOfRange, "must be a multiple of 16");
    }
    if (const auto v = in.find("back_steps")) transport.backSteps = v->integerInt(1, 16);
    if (const auto v = in.find("receiver_steps")) transport.receiverSteps = v->integerInt(1, 32);
    if (const auto v = in.find("gap_fill")) transport.gapFill = v->boolean();
    if (const auto v = in.find("filter")) transport.filter = v->boolean();
    if (const auto v = in.find("force_dispersive")) transport.forceDispersive = v->boolean();
    if (const auto v = in.find("hierarchy_levels")) transport.hierarchyLevels = v->integerInt(1, 6);
    if (const auto v = in.find("bounces")) transport.bounces = v->integerInt(0, 32);
    if (const auto v = in.find("exact_receivers")) transport.exactReceivers = v->boolean();
    if (const auto v = in.find("budget_ms")) transport.budgetMs = v->number(0, 60000);
    if (const auto v = in.find("target_error")) transport.targetError = v->number(0, 1);
    in.finish();
    checkTransport(item, transport);
    return transport;
}

// What the fields of `stream` must be together.
void checkStream(const Item& item, const StreamState& stream) {
    const auto contradict = [&](const char* field, const char* message) {
        Item(&item.json(), &item, field, 0, item.decoding()).fail(ErrorCode::BadRequest, message);
    };
    const bool isImage = stream.encoding == Encoding::Jpeg || stream.encoding == Encoding::Png;
    if (stream.target == Target::Spectral && isImage)
        contradict("encoding", "the spectral map has only \"raw\" and \"zstd\"");
    else if (isImage && stream.sample != Sample::U8)
        contradict("sample", "\"jpeg\" and \"png\" have only \"u8\"");
    else if (stream.target == Target::Spectral && stream.sample == Sample::U8)
        contradict("sample", "the spectral map has only \"f16\" and \"f32\"");
}

StreamState decodeStream(const Item& item, const Limits& limits) {
    Fields in(item);
    StreamState stream;
    const int minSide = int(limits.frameMinSide), maxSide = int(limits.frameMaxSide);
    if (const auto v = in.find("target")) decodeTarget(*v, stream.target, stream.pass);
    if (const auto v = in.find("encoding")) stream.encoding = v->oneOf(kEncodings);
    if (const auto v = in.find("sample")) stream.sample = v->oneOf(kSamples);
    if (const auto v = in.find("bands")) stream.wavelengthBands = v->oneOf(kBands);
    if (const auto v = in.find("width")) stream.width = v->integerInt(minSide, maxSide);
    if (const auto v = in.find("height")) stream.height = v->integerInt(minSide, maxSide);
    if (std::uint64_t(stream.width) * std::uint64_t(stream.height) > limits.framePixels)
        item.fail(ErrorCode::OutOfRange, "width * height must not exceed " + std::to_string(limits.framePixels));
    if (const auto v = in.find("quality"); v && v->size(1, 2) > 0) {
        const std::size_t count = (*v)[0].oneOf(kQualities) ? 1 : 2;
        if (v->size(count, count) == 2) stream.jpegQuality = (*v)[1].integerInt(1, 100);
    }
    if (const auto v = in.find("max_fps")) stream.maxFps = v->number(1, 240);
    in.finish();
    checkStream(item, stream);
    return stream;
}

// The spectral map as it would travel.
void checkMapBytes(const Item& root, const State& state, const Limits& limits) {
    if (state.stream.target != Target::Spectral) return;
    std::uint64_t bands = 3;
    if (state.stream.wavelengthBands) {
        bands = !state.transport.wavelengthsNm.empty()             ? state.transport.wavelengthsNm.size()
                : state.transport.wavelengths == kContinuous ? std::uint64_t(kContinuousBands)
                                                             : std::uint64_t(state.transport.wavelengths);
        for (const auto& [name, light] : state.lights)
            if (light.spectrum && std::holds_alternative<Lines>(*light.spectrum))
                bands = std::max<std::uint64_t>(bands, std::get<Lines>(*light.spectrum).nm.size());
    }
    const std::uint64_t side = std::uint64_t(state.transport.mapSize);
    if (side * side * bands * sampleBytes(state.stream.sample) > limits.framePayloadBytes)
        Item(&root.json(), &root, "transport.map_size", 0, root.decoding())
            .fail(ErrorCode::OutOfRange, "this map with these bands and samples is larger than a frame may be");
}

}  // namespace

tl::expected<State, DecodeError> decodeState(const Json& document, const Limits& limits, bool strict) {
    Decoding decoding{strict, {}};
    const Item root(document, decoding);
    Fields in(root);
    State state;
    if (const auto v = in.find("scene")) state.scene = decodeScene(*v);
    if (const auto v = in.find("lights")) state.lights = decodeNamed(*v, decodeLight);
    if (const auto v = in.find("materials")) state.materials = decodeNamed(*v, decodeMaterial);
    if (const auto v = in.find("camera")) state.camera = decodeCamera(*v);
    if (const auto v = in.find("environment")) {
        Fields environment(*v);
        if (const auto color = environment.find("color")) state.environmentColor = color->vec3(0, 1e6);
        environment.finish();
    }
    if (const auto v = in.find("outside_index")) state.outsideIndex = v->number(1, 5);
    if (const auto v = in.find("transport")) state.transport = decodeTransport(*v, limits);
    if (const auto v = in.find("stream")) state.stream = decodeStream(*v, limits);
    in.finish();
    if (!decoding.error) checkMapBytes(root, state, limits);
    if (decoding.error) return tl::unexpected(*std::move(decoding.error));
    return state;
}

}  // namespace caustream::protocol
