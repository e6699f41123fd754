// Hostile files: every one is a clear error, soon, and without memory taken for lengths that were only claimed.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>

#include "glb_editor.h"

namespace caustream::test {
namespace {

void expectError(const std::vector<std::uint8_t>& file, const std::string& part) {
    const auto scene = load(file);
    ASSERT_FALSE(scene) << "loaded, though: " << part;
    EXPECT_NE(scene.error().message.find(part), std::string::npos) << scene.error().message;
    EXPECT_EQ(scene.error().message.find('\n'), std::string::npos);
}

void expectError(const Glb& glb, const std::string& part) {
    expectError(glb.pack(), part);
}

// A tetrahedron changed by `edit`.
Glb edited(const std::function<void(json&)>& edit) {
    Glb glb = glassTetrahedron();
    edit(glb.root);
    return glb;
}

long peakKilobytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

TEST(BadGlb, CutShortAnywhereIsAnError) {
    const std::vector<std::uint8_t> whole = glassTetrahedron().pack();
    ASSERT_TRUE(load(whole));
    for (std::size_t length = 0; length < whole.size(); length += 4) {
        std::vector<std::uint8_t> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
        EXPECT_FALSE(load(cut)) << length;
        if (length < 12) continue;
        // The same with a header that owns up to the length: now the chunks or the JSON must notice.
        const auto claimed = static_cast<std::uint32_t>(length);
        std::memcpy(cut.data() + 8, &claimed, 4);
        EXPECT_FALSE(load(cut)) << length;
    }
}

TEST(BadGlb, HeaderThatIsNone) {
    expectError(std::vector<std::uint8_t>{}, "too short");
    expectError(packText("{}", {}), "glTF cannot be read");
    std::vector<std::uint8_t> file = triangle().pack();
    file[0] = 'x';
    expectError(file, "not a GLB");
    file = triangle().pack();
    file[4] = 1;
    expectError(file, "version 1");
}

TEST(BadGlb, ChunksThatLieAboutTheirLength) {
    for (const std::size_t at : {8u, 12u}) {
        for (const std::uint32_t lie : {0u, 1u, 0x7FFFFFFFu, 0xFFFFFFFCu, 0xFFFFFFFFu}) {
            std::vector<std::uint8_t> file = triangle().pack();
            std::memcpy(file.data() + at, &lie, 4);
            EXPECT_FALSE(load(file)) << at << " " << lie;
        }
    }
}

TEST(BadGlb, JsonThatIsNone) {
    expectError(packText("not json at all", {}), "glTF cannot be read");
    expectError(packText(R"({"asset":{"version":"2.0"},"meshes":7})", {}), "no mesh");
    expectError(packText("[]", {}), "glTF cannot be read");
    expectError(packText(std::string(100'000, '['), {}), "nested deeper");
    expectError(packText("{\"asset\":{\"version\":\"2.0\"},\"extras\":[0" +
                             [] {
                                 std::string many;
                                 for (int i = 0; i < 600'000; ++i) many += ",0";
                                 return many;
                             }() +
                             "]}",
                         {}),
                "values");
}

TEST(BadGlb, NoMesh) {
    expectError(packText(R"({"asset":{"version":"2.0"}})", {}), "no mesh");
    expectError(edited([](json& root) { root["nodes"][0].erase("mesh"); }), "no mesh");
}

TEST(BadGlb, OutsideFilesAreNeverOpened) {
    const std::string self = "/proc/self/exe";  // exists, and would load as some bytes
    for (const std::string& uri : {self, "file://" + self, std::string("http://127.0.0.1/x.bin"), std::string("x.bin"),
                                   std::string("../../x.bin"), std::string("~/x"), std::string("$HOME/x")}) {
        expectError(edited([&](json& root) { root["buffers"] = {{{"byteLength", 4}, {"uri", uri}}}; }), "never opened");
        expectError(edited([&](json& root) { root["images"] = {{{"uri", uri}}}; }), "never opened");
    }
}

TEST(BadGlb, RequiredExtensionsAreNamed) {
    const Glb glb = edited([](json& root) { root["extensionsRequired"] = {"KHR_lights_punctual", "EXT_teapots"}; });
    expectError(glb, "EXT_teapots");
    EXPECT_TRUE(load(edited([](json& root) { root["extensionsUsed"] = {"EXT_teapots"}; })));
}

TEST(BadGlb, AccessorsOutsideTheirViews) {
    const auto accessor = [](const char* key, const json& value) {
        return edited([&](json& root) { root["accessors"][0][key] = value; });
    };
    expectError(accessor("bufferView", 99), "buffer view 99");
    expectError(accessor("bufferView", 1), "do not fit");
    expectError(accessor("count", 5), "accessor 0");
    expectError(accessor("count", 0), "accessor 0");
    expectError(accessor("byteOffset", 4), "accessor 0");
    expectError(accessor("byteOffset", 1'000'000), "accessor 0");
    expectError(accessor("type", "VEC2"), "components");
    EXPECT_FALSE(load(accessor("componentType", 5130)));
    EXPECT_FALSE(load(accessor("componentType", 1)));
    EXPECT_FALSE(load(accessor("type", "VEC9")));
    expectError(edited([](json& root) { root["accessors"][1]["componentType"] = 5126; }), "unsigned");
}

TEST(BadGlb, ViewsOutsideTheirBuffers) {
    const auto view = [](const char* key, const json& value) {
        return edited([&](json& root) { root["bufferViews"][0][key] = value; });
    };
    EXPECT_FALSE(load(view("buffer", 7)));
    EXPECT_FALSE(load(view("byteLength", 1'000'000)));
    EXPECT_FALSE(load(view("byteOffset", 1'000'000)));
    EXPECT_FALSE(load(view("byteOffset", 18446744073709551612u)));
    EXPECT_FALSE(load(view("byteStride", 8)));
    EXPECT_FALSE(load(view("byteStride", 252)));
    EXPECT_FALSE(load(edited([](json& root) { root["buffers"] = {{{"byteLength", 1'000'000'000}}}; })));
}

TEST(BadGlb, ThingsThatAreNotThere) {
    const auto primitive = [](const char* key, const json& value) {
        return edited([&](json& root) { root["meshes"][0]["primitives"][0][key] = value; });
    };
    expectError(primitive("material", 3), "material 3");
    expectError(primitive("indices", 9), "accessor");
    expectError(primitive("attributes", {{"POSITION", 9}}), "accessor 9");
    expectError(primitive("attributes", {{"NORMAL", 0}}), "no POSITION");
    expectError(edited([](json& root) { root["nodes"][0]["mesh"] = 5; }), "mesh 5");
    expectError(edited([](json& root) { root["scenes"][0]["nodes"] = {4}; }), "node 4");
    expectError(edited([](json& root) { root["scenes"][0]["nodes"] = {-1}; }), "node -1");
    EXPECT_FALSE(load(edited([](json& root) { root["scene"] = 3; })));
    expectError(
        edited([](json& root) { root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 2; }),
        "texture 2");
    expectError(edited([](json& root) { root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 2; }),
                "light");
}

TEST(BadGlb, ImagesOutsideTheirBuffers) {
    const auto image = [](const json& view) {
        return edited([&](json& root) {
            root["bufferViews"].push_back(view);
            root["images"] = {{{"bufferView", 2}, {"mimeType", "image/png"}}};
            root["textures"] = {{{"source", 0}}};
            root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
        });
    };
    EXPECT_FALSE(load(image({{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 1'000'000'000}})));
    EXPECT_FALSE(load(image({{"buffer", 0}, {"byteOffset", 1'000'000'000}, {"byteLength", 4}})));
    EXPECT_FALSE(load(image({{"buffer", 9}, {"byteOffset", 0}, {"byteLength", 4}})));
    EXPECT_FALSE(load(image({{"buffer", -1}, {"byteOffset", 0}, {"byteLength", 4}})));
}

TEST(BadGlb, IndicesOutsideTheVertices) {
    Glb glb = glassTetrahedron();
    const int view = glb.view(std::vector<std::uint16_t>{0, 2, 1, 0, 3, 2, 0, 1, 3, 1, 2, 4});
    glb.root["accessors"][1]["bufferView"] = view;
    expectError(glb, "indices");
}

TEST(BadGlb, PositionsThatAreNoNumbers) {
    for (float bad : {NAN, INFINITY}) {
        Glb glb = glassTetrahedron();
        std::memcpy(glb.binary.data() + 16, &bad, 4);
        expectError(glb, "NaN or infinity");
    }
    expectError(edited([](json& root) { root["nodes"][0]["scale"] = {1e39, 1e39, 1e39}; }), "beyond 1e8 m");
}

TEST(BadGlb, NormalsThatAreNoNumbersBecomeFlat) {
    Glb glb = triangle();
    const int view = glb.view(std::vector<float>{NAN, 0, 0, 0, 0, 0, INFINITY, 0, 0});
    glb.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = glb.accessor(view, 5126, 3, "VEC3");
    const auto scene = load(glb);
    ASSERT_TRUE(scene) << scene.error().message;
    for (int i = 0; i < 3; ++i) EXPECT_EQ(scene->geometry->vertices[i].normal, glm::vec3(0, 1, 0));
}

TEST(BadGlb, NodesThatAreTheirOwnAncestors) {
    expectError(edited([](json& root) { root["nodes"][0]["children"] = {0}; }), "node 0");
    expectError(edited([](json& root) {
                    root["nodes"].push_back({{"children", {0}}});
                    root["nodes"][0]["children"] = {1};
                }),
                "node");
}

TEST(BadGlb, HugeCountsTakeNoMemory) {
    const long before = peakKilobytes();
    for (const json& count : {json(1'000'000'000), json(4'294'967'295u), json(9'007'199'254'740'991), json(-1)}) {
        EXPECT_FALSE(load(edited([&](json& root) { root["accessors"][0]["count"] = count; })));
        EXPECT_FALSE(load(edited([&](json& root) {  // without a view: zeros that need no bytes
            root["accessors"][0]["count"] = count;
            root["accessors"][0].erase("bufferView");
        })));
        EXPECT_FALSE(load(edited([&](json& root) {
            root["accessors"][0]["sparse"] = {{"count", count},
                                              {"indices", {{"bufferView", 1}, {"componentType", 5123}}},
                                              {"values", {{"bufferView", 0}}}};
        })));
    }
    EXPECT_LT(peakKilobytes() - before, 64 * 1024);
}

TEST(BadGlb, ManyInstancesOfOneMeshAreCounted) {
    Glb glb = glassTetrahedron();
    for (int i = 1; i < 100; ++i) {
        glb.root["nodes"].push_back({{"mesh", 0}});
        glb.root["scenes"][0]["nodes"].push_back(i);
    }
    const std::vector<std::uint8_t> file = glb.pack();
    scene::LoadLimits limits;
    limits.casters = 1000;
    EXPECT_TRUE(load(file, limits));
    limits.triangles = 100;
    EXPECT_FALSE(load(file, limits));
    expectError(file, "transmissive objects");
}

TEST(BadGlb, FilesOverTheLimitAreNotLookedAt) {
    scene::LoadLimits limits;
    limits.bytes = 100;
    const std::vector<std::uint8_t> file = triangle().pack();
    const auto scene = load(file, limits);
    ASSERT_FALSE(scene);
    EXPECT_NE(scene.error().message.find("bytes"), std::string::npos);
}

// Any answer will do, as long as there is one and sanitizers are silent.
TEST(BadGlb, RandomChangesNeverCrash) {
    std::mt19937 random(20);
    Glb glb = glassTetrahedron();
    glb.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}}};
    glb.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    glb.root["accessors"][0]["sparse"] = {
        {"count", 1}, {"indices", {{"bufferView", 1}, {"componentType", 5123}}}, {"values", {{"bufferView", 0}}}};
    glb.root["materials"][0]["extras"]["caustream"] = {{"cauchy", {1.5, 0.01}}, {"absorption", {{380, 680}, {1, 2}}}};
    const std::vector<std::uint8_t> whole = glb.pack();
    ASSERT_TRUE(load(whole));
    int loaded = 0;
    const auto tries = [&](std::vector<std::uint8_t> file) { loaded += load(file).has_value(); };
    for (int i = 0; i < 3000; ++i) {
        std::vector<std::uint8_t> file = whole;
        for (unsigned k = 0; k <= random() % 3; ++k)
            file[20 + random() % (file.size() - 20)] = static_cast<std::uint8_t>(random());
        tries(file);
    }
    // Numbers and types inside the JSON exchanged for others: gets past the parser more often.
    const std::vector<json> values{-1,     0,   1,  3,       255,  1e9,           1e300,
                                   -1e300, "x", "", nullptr, true, json::array(), json::object()};
    const json flat = glb.root.flatten();
    for (const auto& [pointer, value] : flat.items())
        for (const json& other : values) {
            Glb changed = glb;
            changed.root[json::json_pointer(pointer)] = other;
            tries(changed.pack());
        }
    EXPECT_GT(loaded, 0);
}

}  // namespace
}  // namespace caustream::test
