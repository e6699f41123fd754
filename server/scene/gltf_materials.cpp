#include "scene/gltf_materials.h"

#include <algorithm>
#include <cmath>

#include "scene/image_decoder.h"

namespace caustream::scene {

namespace {

constexpr std::size_t kMaxTableEntries = 1024;
constexpr double kMaxEmission = 1e6;  // as the colours of a state document
constexpr double kMinIndex = 1.0, kMaxIndex = 10.0;  // of refraction, over the band
constexpr double kMostPriority = 1000.0;  // and least: a whole number that any type holds
// Of GGX facet normals half lie within atan(roughness^2) of the surface's: 2.3 degrees here. Rougher metal blurs what it
// throws over more than the caustics that a mirror would draw.
constexpr float kMirrorRoughness = 0.2f, kMirrorMetal = 0.9f;

tl::unexpected<LoadError> fail(std::string message) {
    return tl::unexpected(LoadError{std::move(message)});
}

const tinygltf::Value* caustreamExtras(const tinygltf::Value& extras, const std::string& key) {
    const tinygltf::Value* own = member(extras, "caustream");
    return own ? member(*own, key) : nullptr;
}

// extras.caustream first, then KHR_materials_dispersion, then KHR_materials_ior.
tl::expected<optics::Dispersion, LoadError> readDispersion(const tinygltf::Material& source, const std::string& what) {
    if (const auto* value = caustreamExtras(source.extras, "cauchy")) {
        const std::vector<double> c = numbers(value);
        if (c.size() != 2 && c.size() != 3) return fail(what + ": cauchy must be [A, B] or [A, B, C], B in um^2");
        return optics::Cauchy{c[0], c[1], c.size() == 3 ? c[2] : 0.0};
    }
    if (const auto* value = caustreamExtras(source.extras, "sellmeier")) {
        const std::vector<double> c = numbers(value);
        if (c.size() != 6) return fail(what + ": sellmeier must be [B1, B2, B3, C1, C2, C3], C in um^2");
        return optics::Sellmeier{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}};
    }
    const auto* iorExtension = extension(source.extensions, "KHR_materials_ior");
    const double ior = iorExtension ? numberOr(member(*iorExtension, "ior"), 1.5) : 1.5;
    const auto* dispersionExtension = extension(source.extensions, "KHR_materials_dispersion");
    const double strength = dispersionExtension ? numberOr(member(*dispersionExtension, "dispersion"), 0.0) : 0.0;
    if (strength < 0.0) return fail(what + ": dispersion must not be negative");
    if (strength > 0.0) return optics::Abbe{ior, 20.0 / strength};
    return optics::ConstantIndex{ior};
}

// At every nm, as a polynomial may leave the range between any few; a resonance does so within less.
bool indexInRange(const optics::Dispersion& dispersion) {
    constexpr double kMinUm2 = optics::kBandMinNm * optics::kBandMinNm * 1e-6, kMaxUm2 = optics::kBandMaxNm * optics::kBandMaxNm * 1e-6;
    if (const auto* sellmeier = std::get_if<optics::Sellmeier>(&dispersion)) {
        for (int i = 0; i < 3; ++i) {
            if (sellmeier->B[i] != 0.0 && sellmeier->C_um2[i] >= kMinUm2 && sellmeier->C_um2[i] <= kMaxUm2) return false;
        }
    }
    for (double nm = optics::kBandMinNm; nm <= optics::kBandMaxNm; nm += 1.0) {
        const double n = optics::refractiveIndex(dispersion, nm);
        if (!(n >= kMinIndex && n <= kMaxIndex)) return false;
    }
    return true;
}

tl::expected<optics::Absorption, LoadError> readAbsorption(const tinygltf::Material& source,
                                                           const tinygltf::Value* volume, const std::string& what) {
    if (const auto* value = caustreamExtras(source.extras, "absorption")) {
        if (!value->IsArray() || value->ArrayLen() != 2)
            return fail(what + ": absorption must be [[nm...], [per_m...]]");
        optics::Absorption table{numbers(&value->Get(0)), numbers(&value->Get(1))};
        const bool ascending =
            std::adjacent_find(table.nm.begin(), table.nm.end(), std::greater_equal<>()) == table.nm.end();
        const bool positive = std::all_of(table.perM.begin(), table.perM.end(), [](double s) { return s >= 0.0; });
        if (table.nm.empty() || table.nm.size() != table.perM.size() || table.nm.size() > kMaxTableEntries ||
            !ascending || !positive)
            return fail(what + ": absorption needs as many per_m >= 0 as nm, with nm ascending");
        return table;
    }
    if (!volume) return optics::Absorption{};
    const double distance = numberOr(member(*volume, "attenuationDistance"), 0.0);
    std::vector<double> color = numbers(member(*volume, "attenuationColor"));
    if (distance <= 0.0 || color.size() != 3) return optics::Absorption{};
    return optics::absorptionFromRgb({color[0], color[1], color[2]}, distance);
}

tl::expected<int, LoadError> readPriority(const tinygltf::Material& source, const std::string& what) {
    const auto* value = caustreamExtras(source.extras, "priority");
    if (!value) return 0;
    const double priority = numberOr(value, NAN);
    if (!(std::abs(priority) <= kMostPriority) || priority != std::trunc(priority))
        return fail(what + ": priority must be a whole number within -1000 to 1000");
    return static_cast<int>(priority);
}

glm::vec3 vector3(const std::vector<double>& values, const glm::vec3& fallback) {
    if (values.size() < 3) return fallback;
    const glm::vec3 v(values[0], values[1], values[2]);
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) ? v : fallback;
}

}  // namespace

tl::expected<int, LoadError> TextureTable::use(int gltfTexture, const std::string& what) {
    const tinygltf::Model& model = file_.model;
    if (gltfTexture < 0 || static_cast<std::size_t>(gltfTexture) >= model.textures.size())
        return fail(what + " names texture " + std::to_string(gltfTexture) + ", which is not there");
    const int image = model.textures[gltfTexture].source;
    if (image < 0 || static_cast<std::size_t>(image) >= model.images.size())
        return fail("texture " + std::to_string(gltfTexture) + " names image " + std::to_string(image) +
                    ", which is not there");
    if (const auto known = ofImage_.find(image); known != ofImage_.end()) return known->second;

    const std::string name = "image " + std::to_string(image);
    std::span<const std::uint8_t> bytes;
    if (const auto inlined = file_.inlineImages.find(image); inlined != file_.inlineImages.end()) {
        bytes = inlined->second;
    } else {
        const auto view = viewBytes(model, model.images[image].bufferView, name);
        if (!view) return tl::unexpected(view.error());
        bytes = *view;
    }
    auto texture = decodeImage(bytes, texelsLeft_, name);
    if (!texture) return tl::unexpected(texture.error());
    texelsLeft_ -= static_cast<std::size_t>(texture->width) * texture->height;
    textures_.push_back(std::move(*texture));
    return ofImage_[image] = static_cast<int>(textures_.size()) - 1;
}

std::string NameTable::unique(const std::string& name, const std::string& kind, std::size_t index) {
    std::string candidate = !name.empty() ? name : index == 0 ? kind : kind + "-" + std::to_string(index);
    const std::string stem = name.empty() ? kind : name;
    while (!taken_.insert(candidate).second) candidate = stem + "-" + std::to_string(index++);
    return candidate;
}

UvSource uvSource(const tinygltf::Material& source) {
    const tinygltf::TextureInfo& info = source.pbrMetallicRoughness.baseColorTexture;
    UvSource uv{info.texCoord};
    const auto* extra = extension(info.extensions, "KHR_texture_transform");
    if (!extra) return uv;
    uv.set = static_cast<int>(std::clamp(numberOr(member(*extra, "texCoord"), uv.set), 0.0, 1e6));
    const std::vector<double> offset = numbers(member(*extra, "offset")), scale = numbers(member(*extra, "scale"));
    const double rotation = numberOr(member(*extra, "rotation"), 0.0), c = std::cos(rotation), s = std::sin(rotation);
    const glm::dvec2 by = scale.size() == 2 ? glm::dvec2(scale[0], scale[1]) : glm::dvec2(1.0);
    uv.transform[0] = glm::dvec3(c * by.x, -s * by.x, 0.0);
    uv.transform[1] = glm::dvec3(s * by.y, c * by.y, 0.0);
    if (offset.size() == 2) uv.transform[2] = glm::dvec3(offset[0], offset[1], 1.0);
    return uv;
}

tl::expected<Material, LoadError> readMaterial(const tinygltf::Material& source, TextureTable& textures,
                                               const std::string& name, std::vector<std::string>& warnings) {
    const std::string what = "material \"" + name + "\"";
    Material material;
    material.name = name;
    material.doubleSided = source.doubleSided;

    // surface
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    if (pbr.baseColorFactor.size() == 4)
        material.baseColor =
            glm::clamp(glm::vec4(vector3(pbr.baseColorFactor, glm::vec3(1.0f)), pbr.baseColorFactor[3]),
                       glm::vec4(0.0f), glm::vec4(1.0f));
    material.roughness = static_cast<float>(std::clamp(pbr.roughnessFactor, 0.0, 1.0));
    material.metallic = static_cast<float>(std::clamp(pbr.metallicFactor, 0.0, 1.0));
    if (pbr.baseColorTexture.index >= 0) {
        const auto texture = textures.use(pbr.baseColorTexture.index, what);
        if (!texture) return tl::unexpected(texture.error());
        material.baseColorTexture = *texture;
    }
    material.emissive = glm::max(vector3(source.emissiveFactor, glm::vec3(0.0f)), glm::vec3(0.0f));
    if (const auto* strength = extension(source.extensions, "KHR_materials_emissive_strength"))
        material.emissive *= static_cast<float>(std::clamp(numberOr(member(*strength, "emissiveStrength"), 1.0), 0.0, kMaxEmission));
    material.emissive = glm::min(material.emissive, glm::vec3(kMaxEmission));

    // glass
    const auto* transmission = extension(source.extensions, "KHR_materials_transmission");
    material.caster = transmission && numberOr(member(*transmission, "transmissionFactor"), 0.0) > 0.0;
    if (!material.caster) {
        // A texture may make parts of it something else
        material.mirror = material.metallic >= kMirrorMetal && material.roughness <= kMirrorRoughness && pbr.metallicRoughnessTexture.index < 0;
        return material;
    }
    const auto* volume = extension(source.extensions, "KHR_materials_volume");
    const bool solid = volume && numberOr(member(*volume, "thicknessFactor"), 0.0) > 0.0;
    material.thinWalled = volume && !solid;
    if (!volume) warnings.push_back(what + " transmits but has no KHR_materials_volume; it is taken as solid glass");
    const auto dispersion = readDispersion(source, what);
    if (!dispersion) return tl::unexpected(dispersion.error());
    if (!indexInRange(*dispersion)) return fail(what + ": its refractive index leaves 1 to 10 within 380-680 nm");
    material.dispersion = *dispersion;
    auto absorption = readAbsorption(source, volume, what);
    if (!absorption) return tl::unexpected(absorption.error());
    material.absorption = std::move(*absorption);
    const auto priority = readPriority(source, what);
    if (!priority) return tl::unexpected(priority.error());
    material.priority = *priority;
    return material;
}

tl::expected<optics::Spectrum, LoadError> readSpectrum(const tinygltf::Value& value, const std::string& what) {
    const std::string kind = value.IsArray() && value.ArrayLen() > 0 && value.Get(0).IsString()
                                 ? value.Get(0).Get<std::string>()
                                 : std::string();
    if (kind == "E") return optics::EqualEnergy{};
    if (kind == "D65") return optics::DaylightD65{};
    if (kind == "blackbody") {
        const double kelvin = numberOr(&value.Get(1), 0.0);
        if (kelvin >= 500.0 && kelvin <= 100'000.0) return optics::Blackbody{kelvin};
    }
    if (kind == "lines" && value.ArrayLen() <= 65) {
        optics::Lines lines;
        for (std::size_t i = 1; i < value.ArrayLen(); ++i)
            lines.nm.push_back(numberOr(&value.Get(static_cast<int>(i)), 0.0));
        const bool inBand = std::all_of(lines.nm.begin(), lines.nm.end(),
                                        [](double nm) { return nm >= optics::kBandMinNm && nm <= optics::kBandMaxNm; });
        if (!lines.nm.empty() && inBand) return lines;
    }
    return fail(what +
                R"(: spectrum must be ["E"], ["D65"], ["blackbody", K] with K in 500..100000, or ["lines", nm...])");
}

}  // namespace caustream::scene
