// The state document, typed: everything a client can ask of its picture. An absent optional means the scene file's
// value. Lengths in metres, angles in degrees, wavelengths in nm; colours linear BT.709.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <variant>
#include <vector>

#include "protocol/errors.h"
#include "protocol/limits.h"

namespace caustream::protocol {

using Json = nlohmann::json;
using Vec3 = std::array<double, 3>;

inline constexpr double kBandMinNm = 380.0, kBandMaxNm = 680.0;

// scene: ["builtin", name] | ["asset", sha256]
struct SceneRef {
    enum class Kind { Builtin, Asset };
    Kind kind = Kind::Builtin;
    std::string name = "gem";  // the built-in scene's name, or the asset's SHA-256 as 64 lower-case hex digits
    bool operator==(const SceneRef&) const = default;
};

// intensity: ["cd", v] | ["W", v] | ["lx", v]
struct Intensity {
    enum class Unit { Candela, Watt, Lux };
    Unit unit = Unit::Candela;
    double value = 0.0;
    bool operator==(const Intensity&) const = default;
};

// spectrum: ["E"] | ["D65"] | ["blackbody", K] | ["lines", nm...]
struct EqualEnergy {
    bool operator==(const EqualEnergy&) const = default;
};
struct DaylightD65 {
    bool operator==(const DaylightD65&) const = default;
};
struct Blackbody {
    double kelvin = 5000.0;
    bool operator==(const Blackbody&) const = default;
};
struct Lines {
    std::vector<double> nm;  // ascending
    bool operator==(const Lines&) const = default;
};
using Spectrum = std::variant<EqualEnergy, DaylightD65, Blackbody, Lines>;

// dispersion: ["constant", n] | ["cauchy", A, B, C?] | ["abbe", n_d, V_d] | ["sellmeier", B1, B2, B3, C1, C2, C3]
struct ConstantIndex {
    double n = 1.5;
    bool operator==(const ConstantIndex&) const = default;
};
struct Cauchy {  // n = A + B / l^2 + C / l^4, l in um
    double A = 1.458, B_um2 = 0.00354, C_um4 = 0.0;
    bool operator==(const Cauchy&) const = default;
};
struct Abbe {
    double n_d = 1.5, V_d = 60.0;
    bool operator==(const Abbe&) const = default;
};
struct Sellmeier {  // n^2 = 1 + sum B_i l^2 / (l^2 - C_i), l in um
    std::array<double, 3> B{}, C_um2{};
    bool operator==(const Sellmeier&) const = default;
};
using Dispersion = std::variant<ConstantIndex, Cauchy, Abbe, Sellmeier>;

// absorption: [[nm...], [per_m...]], ascending; both empty: none, whatever the file says
struct Absorption {
    std::vector<double> nm, perM;
    bool operator==(const Absorption&) const = default;
};

// cookie: ["none"] | ["texture", index into the scene's textures]
struct Cookie {
    std::optional<std::uint32_t> texture;
    bool operator==(const Cookie&) const = default;
};

enum class LightType { Spot, Point, Directional };

struct LightState {
    std::optional<LightType> type;
    std::optional<Vec3> position;   // m
    std::optional<Vec3> direction;  // the way the light travels; any length but 0
    std::optional<double> halfAngleDeg, innerAngleDeg;
    std::optional<Intensity> intensity;
    std::optional<Vec3> color;
    std::optional<Spectrum> spectrum;
    std::optional<Cookie> cookie;
    bool operator==(const LightState&) const = default;
};

struct MaterialState {
    std::optional<Dispersion> dispersion;
    std::optional<Absorption> absorption;
    bool operator==(const MaterialState&) const = default;
};

struct CameraState {
    std::optional<Vec3> eye, target, up;
    std::optional<double> fovYDeg;
    std::optional<double> exposureEv;  // exposure: ["auto"] | ["ev", v]; nothing: automatic
    bool operator==(const CameraState&) const = default;
};

enum class TransportMode { Auto, Traced, Refined, Thesis };

inline constexpr int kContinuous = 0;   // of TransportState::wavelengths
inline constexpr int kContinuousBands = 7;  // wavelengths of a map in bands that asks for "continuous"

struct TransportState {
    TransportMode mode = TransportMode::Auto;
    int wavelengths = kContinuous;      // or 1..64; ignored when wavelengthsNm is given
    std::vector<double> wavelengthsNm;  // exact wavelengths, ascending
    int photonGrid = 0;                 // 0: chosen by the server
    int mapSize = 512;
    int backSteps = 4;
    int receiverSteps = 6;
    bool gapFill = false, filter = true, forceDispersive = false;
    int hierarchyLevels = 3;            // thesis: of the photon hierarchy
    int bounces = 8;                    // traced: reflections inside a caster that are followed
    bool exactReceivers = false;        // traced: light meets the receivers' triangles, not what the map's view sees of them
    double budgetMs = 0.0;              // 0: none
    double targetError = 0.0;           // relative L1 of the map; 0: none, or of a traced map: 0.01
    bool operator==(const TransportState&) const = default;
};

enum class Target : std::uint8_t { Composite = 1, Spectral = 2, Pass = 3 };  // values of the frame header
enum class Encoding : std::uint8_t { Jpeg = 1, Raw = 2, Zstd = 3, Png = 4 };
enum class Sample : std::uint8_t { U8 = 1, F16 = 2, F32 = 3 };

struct StreamState {
    Target target = Target::Composite;
    std::string pass;  // Target::Pass: its name, one of welcome.passes
    Encoding encoding = Encoding::Jpeg;
    Sample sample = Sample::U8;
    bool wavelengthBands = false;    // Target::Spectral: one band per wavelength instead of RGB
    int width = 512, height = 512;   // of pictures; the spectral map has mapSize a side
    std::optional<int> jpegQuality;  // nothing: automatic
    double maxFps = 60.0;
    bool operator==(const StreamState&) const = default;
};

struct State {
    SceneRef scene;
    std::map<std::string, LightState> lights;        // by name
    std::map<std::string, MaterialState> materials;  // by name
    CameraState camera;
    std::optional<Vec3> environmentColor;
    std::optional<double> outsideIndex;
    TransportState transport;
    StreamState stream;
    bool operator==(const State&) const = default;
};

// A document (an object; {} is every default) -> State. Errors name the field.
tl::expected<State, DecodeError> decodeState(const Json& document, const Limits& limits = {}, bool strict = false);

// The document of a state: transport and stream written out, overrides only where they are set.
Json toJson(const State& state);
Json toJson(const Dispersion& dispersion);

}  // namespace caustream::protocol
