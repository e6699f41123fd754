// The names of enumerated values on the wire, once for reading and writing.
#pragma once
#include "protocol/client_messages.h"
#include "protocol/fields.h"
#include "protocol/server_messages.h"

namespace caustream::protocol {

inline constexpr Choice<SceneRef::Kind> kSceneKinds[] = {{"builtin", SceneRef::Kind::Builtin},
                                                         {"asset", SceneRef::Kind::Asset}};
inline constexpr Choice<LightType> kLightTypes[] = {
    {"spot", LightType::Spot}, {"point", LightType::Point}, {"directional", LightType::Directional}};
inline constexpr Choice<Intensity::Unit> kIntensityUnits[] = {
    {"cd", Intensity::Unit::Candela}, {"W", Intensity::Unit::Watt}, {"lx", Intensity::Unit::Lux}};
inline constexpr Choice<std::size_t> kSpectra[] = {{"E", 0}, {"D65", 1}, {"blackbody", 2}, {"lines", 3}};
inline constexpr Choice<std::size_t> kDispersions[] = {{"constant", 0}, {"cauchy", 1}, {"abbe", 2}, {"sellmeier", 3}};
inline constexpr Choice<bool> kExposures[] = {{"auto", true}, {"ev", false}};
inline constexpr Choice<bool> kQualities[] = {{"auto", true}, {"fixed", false}};
inline constexpr Choice<bool> kCookies[] = {{"none", false}, {"texture", true}};
inline constexpr Choice<TransportMode> kTransportModes[] = {{"auto", TransportMode::Auto},
                                                            {"traced", TransportMode::Traced},
                                                            {"refined", TransportMode::Refined},
                                                            {"thesis", TransportMode::Thesis}};
inline constexpr std::string_view kContinuousName = "continuous";
inline constexpr Choice<bool> kBands[] = {{"rgb", false}, {"wavelengths", true}};
inline constexpr Choice<Encoding> kEncodings[] = {
    {"jpeg", Encoding::Jpeg}, {"png", Encoding::Png}, {"raw", Encoding::Raw}, {"zstd", Encoding::Zstd}};
inline constexpr Choice<Sample> kSamples[] = {{"u8", Sample::U8}, {"f16", Sample::F16}, {"f32", Sample::F32}};
inline constexpr Choice<Layout> kLayouts[] = {
    {"interleaved", Layout::Interleaved}, {"planar", Layout::Planar}, {"planar+shuffle", Layout::PlanarShuffle}};
inline constexpr Choice<Role> kRoles[] = {{"control", Role::Control}, {"view", Role::View}};
inline constexpr Choice<Status::Level> kLevels[] = {
    {"info", Status::Level::Info}, {"warning", Status::Level::Warning}, {"error", Status::Level::Error}};
inline constexpr Choice<Goaway::Reason> kReasons[] = {
    {"drain", Goaway::Reason::Drain}, {"shutdown", Goaway::Reason::Shutdown}, {"takeover", Goaway::Reason::Takeover}};

inline constexpr std::size_t kNameBytes = 128;  // of lights, materials, scenes, passes

// Tagged arrays, and what both the state document and the messages hold.
SceneRef decodeScene(const Item& item);
Intensity decodeIntensity(const Item& item);
Spectrum decodeSpectrum(const Item& item);
Cookie decodeCookie(const Item& item);
Absorption decodeAbsorption(const Item& item);
Dispersion decodeDispersion(const Item& item);
void decodeTarget(const Item& item, Target& target, std::string& pass);
std::string targetName(Target target, const std::string& pass);

}  // namespace caustream::protocol
