// Small files that would become large in memory: what is taken is bounded by the bytes that arrived.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <turbojpeg.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "glb_editor.h"
#include "scenes/png.h"

namespace caustream::test {
namespace {

using File = std::vector<std::uint8_t>;

long peakKilobytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

// The loader's own structs have a few hundred bytes for each thing that a file lists. What is freed, a sanitizer keeps.
#ifdef __SANITIZE_ADDRESS__
constexpr long kRoomKilobytes = 1024 * 1024;
#else
constexpr long kRoomKilobytes = 96 * 1024;
#endif

// Loading `file` is the error that holds `part` ("": no error) and takes no memory to speak of.
void expectSmall(const File& file, const std::string& part) {
    const long before = peakKilobytes();
    const auto scene = load(file);
    EXPECT_LT(peakKilobytes() - before, kRoomKilobytes) << part;
    if (part.empty()) {
        EXPECT_TRUE(scene) << scene.error().message;
        return;
    }
    ASSERT_FALSE(scene) << "loaded, though: " << part;
    EXPECT_NE(scene.error().message.find(part), std::string::npos) << scene.error().message;
}

Glb textured(const File& image) {
    Glb glb = triangle();
    glb.root["images"] = {{{"mimeType", "image/png"}, {"bufferView", glb.view(image)}}};
    glb.root["textures"] = {{{"source", 0}}};
    glb.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    glb.root["meshes"][0]["primitives"][0]["material"] = 0;
    return glb;
}

void putBigEndian(File& bytes, std::size_t at, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) bytes[at + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

// IHDR is the first chunk: length, "IHDR", width, height, five more bytes, CRC over all but the length.
File pngThatSays(std::uint32_t width, std::uint32_t height) {
    File png = scenes::encodePng(2, 2, File(12, 7));
    putBigEndian(png, 16, width);
    putBigEndian(png, 20, height);
    putBigEndian(png, 29, static_cast<std::uint32_t>(crc32(0, png.data() + 12, 17)));
    return png;
}

File jpegThatSays(std::uint16_t width, std::uint16_t height) {
    const std::unique_ptr<void, int (*)(void*)> encoder(tjInitCompress(), tjDestroy);
    const File rgb(16 * 16 * 3, 100);
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    tjCompress2(encoder.get(), rgb.data(), 16, 0, 16, TJPF_RGB, &bytes, &size, TJSAMP_444, 80, 0);
    File jpeg(bytes, bytes + size);
    tjFree(bytes);
    const std::uint8_t start[] = {0xFF, 0xC0};  // SOF0: length, precision, height, width
    const auto frame = std::search(jpeg.begin(), jpeg.end(), std::begin(start), std::end(start)) - jpeg.begin();
    const std::uint8_t sides[] = {static_cast<std::uint8_t>(height >> 8), static_cast<std::uint8_t>(height),
                                  static_cast<std::uint8_t>(width >> 8), static_cast<std::uint8_t>(width)};
    std::copy(std::begin(sides), std::end(sides), jpeg.begin() + frame + 5);
    return jpeg;
}

TEST(SwellingGlb, PicturesThatPromise) {
    EXPECT_TRUE(load(textured(pngThatSays(2, 2))));
    EXPECT_TRUE(load(textured(jpegThatSays(16, 16))));
    for (const std::uint32_t side : {2'000u, 8'000u, 100'000u, 999'999u})
        expectSmall(textured(pngThatSays(side, side)).pack(), "more texels than are allowed");
    expectSmall(textured(pngThatSays(0x7FFFFFFF, 1)).pack(), "image 0");
    for (const std::uint16_t side : {2'000, 8'000, 65'500})
        expectSmall(textured(jpegThatSays(side, side)).pack(), "more texels than are allowed");
    expectSmall(textured(jpegThatSays(0, 0)).pack(), "image 0");
}

TEST(SwellingGlb, AWhitePictureOfAMillionTexelsIsNoBomb) {
    const File png = scenes::encodePng(1024, 1024, File(1024 * 1024 * 3, 255));
    EXPECT_LT(png.size(), 10'000u);
    const auto scene = load(textured(png));
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->geometry->textures.at(0).width, 1024);
}

TEST(SwellingGlb, ZerosThatNeedNoBytes) {
    Glb glb = triangle();
    glb.root["accessors"][0].erase("bufferView");
    glb.root["accessors"][0]["count"] = 20'000'000;
    expectSmall(glb.pack(), "elements");
}

TEST(SwellingGlb, BuffersThatCopyTheBinaryChunk) {
    Glb glb = triangle();
    glb.binary.resize(4 << 20);
    glb.root["buffers"] = json::array();
    for (int i = 0; i < 60; ++i) glb.root["buffers"].push_back({{"byteLength", glb.binary.size()}});
    expectSmall(glb.pack(), "buffer 1 has no uri");
}

TEST(SwellingGlb, ListsOfNothing) {
    const auto listed = [](const char* list, int count) {
        Glb glb = triangle();
        glb.root[list] = json::array();
        for (int i = 0; i < count; ++i) glb.root[list].push_back(json::object());
        return glb.pack();
    };
    for (const char* list : {"materials", "textures", "images", "samplers", "animations", "skins", "cameras", "scenes"})
        expectSmall(listed(list, 100'000), std::string("100000 ") + list);
    Glb glb = triangle();
    for (int i = 0; i < 120'000; ++i) glb.root["meshes"][0]["primitives"].push_back(json::object());
    expectSmall(glb.pack(), "primitives");
    glb = triangle();
    for (int i = 0; i < 300; ++i) glb.root["extensions"]["KHR_lights_punctual"]["lights"].push_back({{"type", "point"}});
    expectSmall(glb.pack(), "lights");
}

TEST(SwellingGlb, ALongNameIsNotCopiedForEveryNode) {
    Glb glb = triangle();
    glb.root["meshes"][0]["name"] = std::string(1'000'000, 'n');
    for (int i = 1; i < 3000; ++i) {
        glb.root["nodes"].push_back({{"mesh", 0}});
        glb.root["scenes"][0]["nodes"].push_back(i);
    }
    expectSmall(glb.pack(), "");
}

TEST(SwellingGlb, EmptyMeshesPlacedOverAndOver) {
    Glb glb = triangle();
    for (int i = 0; i < 2000; ++i) glb.root["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
    for (int i = 1; i < 2000; ++i) {
        glb.root["nodes"].push_back({{"mesh", 0}});
        glb.root["scenes"][0]["nodes"].push_back(i);
    }
    expectSmall(glb.pack(), "unfolds");
}

TEST(SwellingGlb, OneLightPlacedOverAndOver) {
    Glb glb = triangle();
    glb.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    for (int i = 1; i < 1000; ++i) {
        glb.root["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
        glb.root["scenes"][0]["nodes"].push_back(i);
    }
    expectSmall(glb.pack(), "lights");
}

TEST(SwellingGlb, ADeepChainOfNodes) {
    Glb glb = triangle();
    for (int i = 0; i < 50'000; ++i) {
        glb.root["nodes"][static_cast<std::size_t>(i)]["children"] = {i + 1};
        glb.root["nodes"].push_back({{"mesh", 0}});
    }
    expectSmall(glb.pack(), "too many nodes");
}

TEST(SwellingGlb, ANodeOfTwoParents) {
    Glb glb = triangle();
    glb.root["nodes"] = {{{"mesh", 0}}, {{"children", {0}}}, {{"children", {0}}}};
    glb.root["scenes"][0]["nodes"] = {1, 2};
    expectSmall(glb.pack(), "node 0 has two parents");
}

TEST(SwellingGlb, WhatIsTooFarAwayToPlaceALightBy) {
    for (const float far : {1.1e8f, 1e20f, 3e38f}) {
        Glb glb = triangle();
        std::memcpy(glb.binary.data(), &far, 4);
        expectSmall(glb.pack(), "beyond 1e8 m");
    }
    Glb glb = triangle();
    glb.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    glb.root["nodes"].push_back({{"translation", {1e30, 0, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    glb.root["scenes"][0]["nodes"].push_back(1);
    expectSmall(glb.pack(), "beyond 1e9 m");
    // A scene of that size is still lit and seen from somewhere.
    glb = triangle();
    const float edge = 1e8f;
    std::memcpy(glb.binary.data(), &edge, 4);
    const auto scene = load(glb);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_LE(scene->lights.at(0).intensity, 1e12f);
    EXPECT_LE(std::abs(scene->lights.at(0).position.y), 1e9f);
}

TEST(SwellingGlb, ErrorsAreOneShortLineWhateverTheNames) {
    Glb glb = triangle();
    glb.root["meshes"][0]["name"] = "line\nbreak";
    glb.root["meshes"][0]["primitives"][0]["material"] = 9;
    const auto scene = load(glb);
    ASSERT_FALSE(scene);
    EXPECT_EQ(scene.error().message.find('\n'), std::string::npos);
    glb.root["extensionsRequired"] = {std::string(100'000, 'x')};
    const auto other = load(glb);
    ASSERT_FALSE(other);
    EXPECT_LE(other.error().message.size(), 300u);
}

// As many warnings as a person reads, whatever the file.
TEST(SwellingGlb, WarningsEnd) {
    Glb glb = triangle();
    for (int i = 0; i < 5000; ++i)
        glb.root["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
    const auto scene = load(glb);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_LE(scene->warnings.size(), 70u);
}

}  // namespace
}  // namespace caustream::test
