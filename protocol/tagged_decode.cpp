// The tagged arrays of the state document: ["tag", value...].
#include <cmath>

#include "protocol/choices.h"

namespace caustream::protocol {
namespace {

constexpr double kMaxIndex = 10.0;
constexpr std::size_t kMaxKnots = 1024;  // of an absorption table

constexpr double kBandMinUm2 = kBandMinNm * kBandMinNm * 1e-6, kBandMaxUm2 = kBandMaxNm * kBandMaxNm * 1e-6;

// Refractive index as README.md defines each formula; NaN where Sellmeier's sum is below 0.
double indexAt(const Dispersion& dispersion, double nm) {
    const double l2 = nm * nm * 1e-6;  // um^2
    if (const auto* constant = std::get_if<ConstantIndex>(&dispersion)) return constant->n;
    if (const auto* cauchy = std::get_if<Cauchy>(&dispersion))
        return cauchy->A + cauchy->B_um2 / l2 + cauchy->C_um4 / (l2 * l2);
    if (const auto* abbe = std::get_if<Abbe>(&dispersion)) {
        // The same dispersion as KHR_materials_dispersion's; its clamp at 1 comes later.
        return abbe->n_d + (abbe->n_d - 1.0) / abbe->V_d * (523655.0 / (nm * nm) - 1.5168);
    }
    const auto& sellmeier = std::get<Sellmeier>(dispersion);
    double n2 = 1.0;
    for (std::size_t i = 0; i < 3; ++i) n2 += sellmeier.B[i] * l2 / (l2 - sellmeier.C_um2[i]);
    return std::sqrt(n2);
}

}  // namespace

SceneRef decodeScene(const Item& item) {
    if (item.size(2, 2) == 0) return {};
    SceneRef scene;
    scene.kind = item[0].oneOf(kSceneKinds);
    scene.name = scene.kind == SceneRef::Kind::Asset ? item[1].sha256() : item[1].text(kNameBytes, 1);
    return scene;
}

Spectrum decodeSpectrum(const Item& item) {
    const std::size_t count = item.size(1, 65);
    if (count == 0) return {};
    switch (item[0].oneOf(kSpectra)) {
        case 0:
            item.size(1, 1);
            return EqualEnergy{};
        case 1:
            item.size(1, 1);
            return DaylightD65{};
        case 2:
            return item.size(2, 2) ? Blackbody{item[1].number(1000, 40000)} : Blackbody{};
        default:
            return Lines{item.ascending(1, 64, kBandMinNm, kBandMaxNm, 1)};
    }
}

Intensity decodeIntensity(const Item& item) {
    if (item.size(2, 2) == 0) return {};
    return {item[0].oneOf(kIntensityUnits), item[1].number(0, 1e12)};
}

Cookie decodeCookie(const Item& item) {
    if (item.size(1, 2) == 0) return {};
    const bool isTexture = item[0].oneOf(kCookies);
    if (item.size(isTexture ? 2 : 1, isTexture ? 2 : 1) < 2) return {};
    return {item[1].u32(0, 4095)};
}

Absorption decodeAbsorption(const Item& item) {
    if (item.size(2, 2) == 0) return {};
    Absorption absorption;
    absorption.nm = item[0].ascending(0, kMaxKnots, 0, 1e6);
    const Item perM = item[1];
    const std::size_t count = perM.size(absorption.nm.size(), absorption.nm.size());
    for (std::size_t i = 0; i < count; ++i) absorption.perM.push_back(perM[i].number(0, 1e12));
    return absorption;
}

Dispersion decodeDispersion(const Item& item) {
    const std::size_t count = item.size(2, 7);
    if (count == 0) return {};
    Dispersion dispersion;
    switch (item[0].oneOf(kDispersions)) {
        case 0:
            if (item.size(2, 2)) dispersion = ConstantIndex{item[1].number(1, kMaxIndex)};
            break;
        case 1:
            if (item.size(3, 4))
                dispersion = Cauchy{item[1].number(-100, 100), item[2].number(-100, 100),
                                    count == 4 ? item[3].number(-100, 100) : 0};
            break;
        case 2:
            if (item.size(3, 3)) dispersion = Abbe{item[1].number(1, kMaxIndex), item[2].number(1e-3, 1e12)};
            break;
        default:
            if (item.size(7, 7)) {
                Sellmeier sellmeier;
                for (std::size_t i = 0; i < 3; ++i) {
                    sellmeier.B[i] = item[1 + i].number(-1e3, 1e3);
                    const double c = sellmeier.C_um2[i] = item[4 + i].number(-1e6, 1e6);
                    if (c >= kBandMinUm2 && c <= kBandMaxUm2)
                        item[4 + i].fail(ErrorCode::OutOfRange, "puts a resonance between 380 and 680 nm");
                }
                dispersion = sellmeier;
            }
    }
    if (item.decoding().error) return {};
    const bool isClamped = std::holds_alternative<Abbe>(dispersion);
    for (double nm = kBandMinNm; nm <= kBandMaxNm; nm += 1.0) {
        const double n = indexAt(dispersion, nm);
        if (!(n >= (isClamped ? -1e9 : 1.0) && n <= kMaxIndex)) {
            item.fail(ErrorCode::OutOfRange, "the index must stay within 1 to 10 between 380 and 680 nm");
            break;
        }
    }
    return dispersion;
}

void decodeTarget(const Item& item, Target& target, std::string& pass) {
    const std::string name = item.text(kNameBytes, 1);
    target = name == "composite" ? Target::Composite : name == "spectral" ? Target::Spectral : Target::Pass;
    pass = target == Target::Pass ? name : std::string();
}

}  // namespace caustream::protocol
