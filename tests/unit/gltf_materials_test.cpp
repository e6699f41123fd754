// Materials: extensions and extras.caustream, each to known numbers; textures; names.
#include <gtest/gtest.h>
#include <png.h>
#include <cmath>

#include "glb_editor.h"

namespace caustream::test {
namespace {

using scene::Material;

Material materialOf(const json& material) {
    Glb glb = glassTetrahedron();
    glb.root["materials"][0].update(material, true);
    auto scene = load(glb);
    if (!scene) {
        ADD_FAILURE() << scene.error().message;
        return {};
    }
    return scene->materials[0];
}

std::string errorOf(const json& material) {
    Glb glb = glassTetrahedron();
    glb.root["materials"][0].update(material, true);
    const auto scene = load(glb);
    return scene ? "" : scene.error().message;
}

json extras(const json& own) {
    return {{"extras", {{"caustream", own}}}};
}

TEST(GltfMaterial, TransmissionMakesACaster) {
    EXPECT_TRUE(materialOf(json::object()).caster);
    const json none{{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.0}}}}}};
    EXPECT_FALSE(materialOf(none).caster);
}

TEST(GltfMaterial, IndexIsOneAndAHalfOrWhatIsSaid) {
    EXPECT_EQ(std::get<optics::ConstantIndex>(materialOf(json::object()).dispersion).n, 1.5);
    const json ior{{"extensions", {{"KHR_materials_ior", {{"ior", 2.4}}}}}};
    EXPECT_EQ(std::get<optics::ConstantIndex>(materialOf(ior).dispersion).n, 2.4);
}

TEST(GltfMaterial, DispersionIsTwentyOverTheAbbeNumber) {
    const json glass{
        {"extensions", {{"KHR_materials_ior", {{"ior", 1.7}}}, {"KHR_materials_dispersion", {{"dispersion", 0.5}}}}}};
    const auto abbe = std::get<optics::Abbe>(materialOf(glass).dispersion);
    EXPECT_EQ(abbe.n_d, 1.7);
    EXPECT_EQ(abbe.V_d, 40.0);
}

TEST(GltfMaterial, ExtrasSayWhatGltfCannot) {
    const auto cauchy = std::get<optics::Cauchy>(materialOf(extras({{"cauchy", {1.6, 0.03}}})).dispersion);
    EXPECT_EQ(cauchy.A, 1.6);
    EXPECT_EQ(cauchy.B_um2, 0.03);
    EXPECT_EQ(cauchy.C_um4, 0.0);
    const json sf11 =
        extras({{"sellmeier", {1.73848403, 0.311168974, 1.17490871, 0.0136068604, 0.0615960463, 121.922711}}});
    EXPECT_NEAR(optics::refractiveIndex(materialOf(sf11).dispersion, 587.56), 1.78472, 1e-5);
    const json table = extras({{"absorption", {{380, 680}, {0.1, 0.3}}}});
    EXPECT_NEAR(materialOf(table).absorption.at(530.0), 0.2, 1e-12);
}

TEST(GltfMaterial, ExtrasThatMakeNoSenseAreErrors) {
    EXPECT_NE(errorOf(extras({{"cauchy", {1.5}}})).find("cauchy"), std::string::npos);
    EXPECT_NE(errorOf(extras({{"cauchy", "glass"}})).find("cauchy"), std::string::npos);
    EXPECT_NE(errorOf(extras({{"cauchy", {0.5, 0.0}}})).find("refractive index"), std::string::npos);
    EXPECT_NE(errorOf(extras({{"cauchy", {1.5, 1e300}}})).find("refractive index"), std::string::npos);
    EXPECT_NE(errorOf(extras({{"sellmeier", {1.0, 2.0}}})).find("sellmeier"), std::string::npos);
    // Fine at both ends of the band and in its middle, not between: a resonance at 450 nm, one too thin to be sampled, a
    // polynomial that dips below 1, an imaginary index
    EXPECT_NE(errorOf(extras({{"sellmeier", {1.0, 0.01, 0.0, 0.01, 0.2025, 0.0}}})).find("refractive index"), std::string::npos);
    EXPECT_NE(errorOf(extras({{"sellmeier", {1.0, 1e-9, 0.0, 0.01, 0.20295025, 0.0}}})).find("refractive index"), std::string::npos);
    EXPECT_NE(errorOf(extras({{"cauchy", {3.82, -1.13, 0.113}}})).find("refractive index"), std::string::npos);
    EXPECT_NE(errorOf(extras({{"sellmeier", {-2.0, 0.0, 0.0, 0.0, 0.0, 0.0}}})).find("refractive index"), std::string::npos);
    EXPECT_NE(errorOf(extras({{"absorption", {{380}, {0.1, 0.3}}}})).find("absorption"), std::string::npos);
    EXPECT_NE(errorOf(extras({{"absorption", {{680, 380}, {0.1, 0.3}}}})).find("absorption"), std::string::npos);
    EXPECT_NE(errorOf(extras({{"absorption", {{380, 680}, {0.1, -0.3}}}})).find("absorption"), std::string::npos);
}

TEST(GltfMaterial, AttenuationBecomesASpectrum) {
    const json glass{
        {"extensions",
         {{"KHR_materials_volume", {{"attenuationDistance", 0.5}, {"attenuationColor", {0.5, 0.5, 0.5}}}}}}};
    const Material material = materialOf(glass);
    EXPECT_NEAR(material.absorption.at(530.0), -std::log(0.5) / 0.5, 1e-3);
}

TEST(GltfMaterial, ThicknessZeroIsThinWalled) {
    const json thin{{"extensions", {{"KHR_materials_volume", {{"thicknessFactor", 0.0}}}}}};
    EXPECT_TRUE(materialOf(thin).thinWalled);
    EXPECT_FALSE(materialOf(json::object()).thinWalled);
}

TEST(GltfMaterial, SurfaceFactors) {
    const json surface{
        {"emissiveFactor", {0.5, 0.25, 0.0}},
        {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4.0}}}}},
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {0.1, 0.2, 0.3, 1.0}}, {"metallicFactor", 0.25}, {"roughnessFactor", 0.75}}}};
    const Material material = materialOf(surface);
    EXPECT_EQ(material.baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 1.0f));
    EXPECT_EQ(material.metallic, 0.25f);
    EXPECT_EQ(material.roughness, 0.75f);
    EXPECT_EQ(material.emissive, glm::vec3(2.0f, 1.0f, 0.0f));
}

TEST(GltfMaterial, SmoothMetalIsAMirror) {
    const auto surface = [](json pbr) {
        json material{{"pbrMetallicRoughness", std::move(pbr)}};
        material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.0;
        return material;
    };
    const Material gold = materialOf(surface({{"metallicFactor", 1.0}, {"roughnessFactor", 0.2}}));
    EXPECT_TRUE(gold.mirror);
    EXPECT_FALSE(gold.caster);
    EXPECT_EQ(gold.priority, 0);
    EXPECT_TRUE(materialOf(surface({{"metallicFactor", 0.9}, {"roughnessFactor", 0.0}})).mirror);
    EXPECT_FALSE(materialOf(surface({{"metallicFactor", 0.8}, {"roughnessFactor", 0.0}})).mirror);
    EXPECT_FALSE(materialOf(surface({{"metallicFactor", 1.0}, {"roughnessFactor", 0.3}})).mirror);
    EXPECT_FALSE(materialOf(surface(json::object())).mirror);   // glTF's default is rough
    // Where light goes through, it does not turn back
    EXPECT_FALSE(materialOf({{"pbrMetallicRoughness", {{"metallicFactor", 1.0}, {"roughnessFactor", 0.0}}}}).mirror);
}

// Light must land somewhere; and what was shown for a thousand chrome bolts before is shown still.
TEST(GltfMaterial, MirrorsGetAFloorAndAreLimited) {
    Glb glb = glassTetrahedron();
    glb.root["materials"][0] = {{"pbrMetallicRoughness", {{"metallicFactor", 1.0}, {"roughnessFactor", 0.1}}}};
    const auto one = load(glb);
    ASSERT_TRUE(one) << one.error().message;
    EXPECT_TRUE(one->materials[0].mirror);
    EXPECT_TRUE(warns(*one, "a floor was placed"));
    for (int i = 0; i < 20; ++i) {
        glb.root["scenes"][0]["nodes"].push_back(glb.root["nodes"].size());
        glb.root["nodes"].push_back({{"mesh", 0}});
    }
    const auto many = load(glb);
    ASSERT_TRUE(many) << many.error().message;
    EXPECT_FALSE(many->materials[0].mirror);
    EXPECT_TRUE(warns(*many, "throws no light"));
}

TEST(GltfMaterial, PriorityIsAWholeNumber) {
    EXPECT_EQ(materialOf(json::object()).priority, 0);
    EXPECT_EQ(materialOf(extras({{"priority", 3}})).priority, 3);
    EXPECT_EQ(materialOf(extras({{"priority", -1000}})).priority, -1000);
    EXPECT_EQ(materialOf(extras({{"priority", 2.0}})).priority, 2);
    for (const json& bad : {json(1.5), json(1001), json(-1e300), json(1e300), json("high"), json(true), json::array({1}), json{{"a", 1}}}) {
        EXPECT_NE(errorOf(extras({{"priority", bad}})).find("priority"), std::string::npos) << bad;
    }
}

// Two texels: red, then green.
std::vector<std::uint8_t> redGreenPng() {
    const std::uint8_t texels[]{255, 0, 0, 255, 0, 255, 0, 255};
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = 2;
    image.height = 1;
    image.format = PNG_FORMAT_RGBA;
    png_alloc_size_t size = 0;
    png_image_write_get_memory_size(image, size, 0, texels, 0, nullptr);
    std::vector<std::uint8_t> bytes(size);
    EXPECT_NE(png_image_write_to_memory(&image, bytes.data(), &size, 0, texels, 0, nullptr), 0);
    bytes.resize(size);
    return bytes;
}

Glb withTexture(const std::vector<std::uint8_t>& png) {
    Glb glb = triangle();
    glb.root["images"] = {{{"bufferView", glb.view(png)}, {"mimeType", "image/png"}}};
    glb.root["textures"] = {{{"source", 0}}};
    glb.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}},
                             {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    glb.root["meshes"][0]["primitives"][0]["material"] = 0;
    return glb;
}

TEST(GltfTexture, PngIsDecodedOnceForAllItsUsers) {
    const auto scene = load(withTexture(redGreenPng()));
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->geometry->textures.size(), 1u);
    const scene::Texture& texture = scene->geometry->textures[0];
    EXPECT_EQ(texture.width, 2);
    EXPECT_EQ(texture.height, 1);
    EXPECT_EQ(texture.rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255}));
    EXPECT_EQ(scene->materials[0].baseColorTexture, 0);
    EXPECT_EQ(scene->materials[1].baseColorTexture, 0);
    EXPECT_EQ(scene->materials[0].name, "material");
    EXPECT_EQ(scene->materials[1].name, "material-1");
}

TEST(GltfTexture, DamagedImagesAreErrorsThatNameThem) {
    std::vector<std::uint8_t> png = redGreenPng();
    for (std::size_t length : {std::size_t{0}, std::size_t{4}, std::size_t{20}, png.size() / 2}) {
        const auto scene = load(withTexture({png.begin(), png.begin() + static_cast<std::ptrdiff_t>(length)}));
        ASSERT_FALSE(scene) << length;
        EXPECT_NE(scene.error().message.find("image 0"), std::string::npos) << scene.error().message;
    }
}

TEST(GltfTexture, TexelsAreLimited) {
    const std::vector<std::uint8_t> file = withTexture(redGreenPng()).pack();
    scene::LoadLimits limits;
    limits.texels = 1;
    const auto scene = load(file, limits);
    ASSERT_FALSE(scene);
    EXPECT_NE(scene.error().message.find("texels"), std::string::npos);
}

TEST(GltfTexture, TransformIsBakedIntoUv) {
    Glb glb = withTexture(redGreenPng());
    const int view = glb.view(std::vector<float>{0, 0, 1, 0, 0, 1});
    glb.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = glb.accessor(view, 5126, 3, "VEC2");
    glb.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
        {"offset", {0.5, 0.25}}, {"scale", {2.0, 4.0}}};
    const auto scene = load(glb);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->geometry->vertices[0].uv, glm::vec2(0.5f, 0.25f));
    EXPECT_EQ(scene->geometry->vertices[1].uv, glm::vec2(2.5f, 0.25f));
    EXPECT_EQ(scene->geometry->vertices[2].uv, glm::vec2(0.5f, 4.25f));
}

TEST(GltfTexture, ALightsCookieIsATexture) {
    Glb glb = withTexture(redGreenPng());
    json light{{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}};
    light["extras"]["caustream"]["cookie"] = 0;
    glb.root["extensions"]["KHR_lights_punctual"]["lights"] = {light};
    glb.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    const auto scene = load(glb);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->lights[0].cookie, 0);
    glb.root["extensions"]["KHR_lights_punctual"]["lights"][0]["extras"]["caustream"]["cookie"] = 5;
    EXPECT_FALSE(load(glb));
}

TEST(GltfScene, EnvironmentAndOutsideIndexRideInExtras) {
    Glb glb = glassTetrahedron();
    glb.root["scenes"][0]["extras"]["caustream"] = {
        {"environment", {0.1, 0.2, 0.3}}, {"outside_index", 1.0003}, {"exposure_bias_ev", -1.5}};
    auto scene = load(glb);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->environmentColor, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(scene->outsideIndex, 1.0003);
    EXPECT_EQ(scene->exposureBiasEv, -1.5f);
    glb.root["scenes"][0]["extras"]["caustream"]["outside_index"] = 0.5;
    scene = load(glb);
    ASSERT_FALSE(scene);
    EXPECT_NE(scene.error().message.find("outside_index"), std::string::npos);
}

}  // namespace
}  // namespace caustream::test
