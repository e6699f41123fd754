// Geometry that a glTF file may hold, loaded to known numbers.
#include <gtest/gtest.h>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "glb_editor.h"

namespace caustream::test {
namespace {

using scene::Geometry;
using scene::Scene;

Scene loaded(const Glb& glb) {
    auto scene = load(glb);
    if (!scene) {
        ADD_FAILURE() << scene.error().message;
        return {};
    }
    return std::move(*scene);
}

// The corners of triangle `t` of the whole geometry.
std::array<scene::Vertex, 3> corners(const Geometry& geometry, std::size_t t) {
    std::array<scene::Vertex, 3> result;
    for (std::size_t k = 0; k < 3; ++k) result[k] = geometry.vertices[geometry.indices[3 * t + k]];
    return result;
}

double volume(const Geometry& geometry, const scene::Object& object) {
    double sum = 0.0;
    for (std::uint32_t i = object.firstIndex; i < object.firstIndex + object.indexCount; i += 3) {
        const auto [a, b, c] = corners(geometry, i / 3);
        sum += glm::dot(glm::dvec3(a.position), glm::cross(glm::dvec3(b.position), glm::dvec3(c.position))) / 6.0;
    }
    return sum;
}

TEST(Gltf, MissingNormalsAreFlatAndCornersUnshared) {
    const Scene scene = loaded(glassTetrahedron());
    const Geometry& geometry = *scene.geometry;
    ASSERT_GE(geometry.objects.size(), 1u);
    EXPECT_EQ(geometry.objects[0].indexCount, 12u);
    EXPECT_NEAR(volume(geometry, geometry.objects[0]), 1.0 / 6.0, 1e-7);
    for (std::size_t t = 0; t < 4; ++t) {
        const auto [a, b, c] = corners(geometry, t);
        const glm::vec3 flat = glm::normalize(glm::cross(b.position - a.position, c.position - a.position));
        for (const auto& vertex : {a, b, c}) EXPECT_LT(glm::distance(vertex.normal, flat), 1e-6f);
    }
    EXPECT_EQ(geometry.objects[0].name, "stone");
}

TEST(Gltf, IndicesOfEveryWidthAndNone) {
    for (int type : {5121, 5123, 5125}) {
        Glb glb = triangle();
        const int view = type == 5121   ? glb.view(std::vector<std::uint8_t>{0, 1, 2})
                         : type == 5123 ? glb.view(std::vector<std::uint16_t>{0, 1, 2})
                                        : glb.view(std::vector<std::uint32_t>{0, 1, 2});
        glb.root["meshes"][0]["primitives"][0]["indices"] = glb.accessor(view, type, 3, "SCALAR");
        const Scene scene = loaded(glb);
        EXPECT_EQ(scene.geometry->indices.size(), 3u);
        EXPECT_FLOAT_EQ(corners(*scene.geometry, 0)[0].normal.y, 1.0f);
    }
    EXPECT_EQ(loaded(triangle()).geometry->indices.size(), 3u);
}

TEST(Gltf, InterleavedAttributesWithNormalisedUv) {
    Glb glb = triangle();
    // position (12 bytes), normal (12), uv as normalised u16 (4)
    std::vector<std::uint8_t> bytes(3 * 28);
    const float positions[3][3] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}, normal[3] = {0, 2, 0};
    const std::uint16_t uvs[3][2] = {{0, 0}, {65535, 0}, {0, 65535}};
    for (int i = 0; i < 3; ++i) {
        std::memcpy(&bytes[28 * i], positions[i], 12);
        std::memcpy(&bytes[28 * i + 12], normal, 12);
        std::memcpy(&bytes[28 * i + 24], uvs[i], 4);
    }
    const int view = glb.view(bytes, 28);
    auto& attributes = glb.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["POSITION"] = glb.accessor(view, 5126, 3, "VEC3");
    attributes["NORMAL"] = glb.accessor(view, 5126, 3, "VEC3", 12);
    attributes["TEXCOORD_0"] = glb.accessor(view, 5123, 3, "VEC2", 24);
    glb.root["accessors"].back()["normalized"] = true;
    const Scene scene = loaded(glb);
    const auto [a, b, c] = corners(*scene.geometry, 0);
    EXPECT_EQ(b.position, glm::vec3(0, 0, 1));
    EXPECT_EQ(a.normal, glm::vec3(0, 1, 0));  // unit, whatever the file's length
    EXPECT_EQ(b.uv, glm::vec2(1, 0));
    EXPECT_EQ(c.uv, glm::vec2(0, 1));
}

TEST(Gltf, SparseAccessorReplacesValues) {
    for (bool overZeros : {false, true}) {
        Glb glb = triangle();
        const int indices = glb.view(std::vector<std::uint16_t>{1, 2});
        const int values = glb.view(std::vector<float>{0, 0, 5, 7, 0, 0});
        json& accessor = glb.root["accessors"][0];
        accessor["sparse"] = {{"count", 2},
                              {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                              {"values", {{"bufferView", values}}}};
        if (overZeros) accessor.erase("bufferView");
        const Scene scene = loaded(glb);
        const auto [a, b, c] = corners(*scene.geometry, 0);
        EXPECT_EQ(a.position, glm::vec3(0));
        EXPECT_EQ(b.position, glm::vec3(0, 0, 5));
        EXPECT_EQ(c.position, glm::vec3(7, 0, 0));
    }
}

TEST(Gltf, StripsAndFansKeepTheirWinding) {
    const std::vector<float> square{0, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0, 1};  // strip order
    const std::vector<float> fan{0, 0, 0, 0, 0, 1, 1, 0, 1, 1, 0, 0};
    for (const auto& [mode, positions] : {std::pair{5, square}, std::pair{6, fan}}) {
        Glb glb = triangle();
        auto& primitive = glb.root["meshes"][0]["primitives"][0];
        primitive["mode"] = mode;
        primitive["attributes"]["POSITION"] = glb.accessor(glb.view(positions), 5126, 4, "VEC3");
        const Scene scene = loaded(glb);
        ASSERT_EQ(scene.geometry->indices.size(), 6u);
        for (std::size_t t = 0; t < 2; ++t) EXPECT_FLOAT_EQ(corners(*scene.geometry, t)[0].normal.y, 1.0f);
    }
}

TEST(Gltf, PointsAndLinesAreLeftOutWithAWarning) {
    Glb glb = triangle();
    json lines = glb.root["meshes"][0]["primitives"][0];
    lines["mode"] = 1;
    glb.root["meshes"][0]["primitives"].push_back(lines);
    const Scene scene = loaded(glb);
    EXPECT_EQ(scene.geometry->indices.size(), 3u);
    EXPECT_TRUE(warns(scene, "no triangles"));
}

TEST(Gltf, NodeTransformsAreBakedThroughTheHierarchy) {
    Glb glb = triangle();
    const double h = std::sqrt(0.5);
    glb.root["nodes"] = {{{"children", {1}}, {"translation", {10, 0, 0}}},
                         {{"children", {2}}, {"rotation", {0, h, 0, h}}},  // 90 degrees about y: x -> -z
                         {{"mesh", 0}, {"scale", {2, 1, 1}}}};
    const Scene scene = loaded(glb);
    const auto [a, b, c] = corners(*scene.geometry, 0);
    EXPECT_LT(glm::distance(a.position, glm::vec3(10, 0, 0)), 1e-5f);
    EXPECT_LT(glm::distance(b.position, glm::vec3(11, 0, 0)), 1e-5f);
    EXPECT_LT(glm::distance(c.position, glm::vec3(10, 0, -2)), 1e-5f);
    EXPECT_LT(glm::distance(c.normal, glm::vec3(0, 1, 0)), 1e-6f);
}

TEST(Gltf, MirroredNodesKeepOutsideOut) {
    for (bool withNormals : {false, true}) {
        Glb glb = glassTetrahedron();
        if (withNormals) {
            const float s = -std::sqrt(1.0f / 3.0f);
            const int view = glb.view(std::vector<float>{s, s, s, 1, 0, 0, 0, 1, 0, 0, 0, 1});
            glb.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = glb.accessor(view, 5126, 4, "VEC3");
        }
        glb.root["nodes"][0]["scale"] = {-2, 1, 1};
        const Scene scene = loaded(glb);
        EXPECT_NEAR(volume(*scene.geometry, scene.geometry->objects[0]), 2.0 / 6.0, 1e-6);
        EXPECT_FALSE(warns(scene, "inside out"));
        // Normals point away from the middle.
        const glm::vec3 middle(-0.5f, 0.25f, 0.25f);
        for (const std::uint32_t i : {0u, 4u, 8u}) {
            const scene::Vertex& vertex = scene.geometry->vertices[scene.geometry->indices[i]];
            EXPECT_GT(glm::dot(vertex.normal, vertex.position - middle), 0.0f);
        }
    }
}

TEST(Gltf, MatrixOfANode) {
    Glb glb = triangle();
    glb.root["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 4, 5, 1};
    EXPECT_EQ(corners(*loaded(glb).geometry, 0)[0].position, glm::vec3(3, 4, 5));
}

TEST(Gltf, PrimitivesOfOneMaterialBecomeOneObject) {
    Glb glb = glassTetrahedron();
    json& primitives = glb.root["meshes"][0]["primitives"];
    const int far = glb.view(std::vector<float>{5, 0, 0, 6, 0, 0, 5, 1, 0, 5, 0, 1});
    json second = primitives[0], third = primitives[0];
    second["attributes"]["POSITION"] = glb.accessor(far, 5126, 4, "VEC3");
    third.erase("material");
    primitives.push_back(second);
    primitives.push_back(third);
    const Scene scene = loaded(glb);
    ASSERT_EQ(scene.geometry->objects.size(), 2u);  // the glass pair, the matte one
    EXPECT_EQ(scene.geometry->objects[0].indexCount, 24u);
    EXPECT_EQ(scene.geometry->objects[1].indexCount, 12u);
    EXPECT_FALSE(scene.materials[scene.geometry->objects[1].material].caster);
    EXPECT_EQ(scene.materials[1].name, "material-1");
}

TEST(Gltf, InsideOutGlassIsTurned) {
    Glb glb = glassTetrahedron();
    const int view = glb.view(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2});
    glb.root["accessors"][1]["bufferView"] = view;
    const Scene scene = loaded(glb);
    EXPECT_TRUE(warns(scene, "inside out"));
    EXPECT_NEAR(volume(*scene.geometry, scene.geometry->objects[0]), 1.0 / 6.0, 1e-7);
}

TEST(Gltf, OpenGlassIsLoadedWithAWarning) {
    Glb glb = glassTetrahedron();
    glb.root["accessors"][1]["count"] = 9;
    const Scene scene = loaded(glb);
    EXPECT_TRUE(warns(scene, "not closed"));
    EXPECT_EQ(scene.geometry->objects[0].indexCount, 9u);
}

TEST(Gltf, TrianglesWithoutAreaAndRepeatedOnesAreLeftOut) {
    Glb glb = glassTetrahedron();
    const int view = glb.view(std::vector<std::uint16_t>{0, 2, 1, 0, 3, 2, 0, 1, 3, 1, 2, 3, 2, 2, 1, 1, 0, 2});
    glb.root["accessors"][1]["bufferView"] = view;
    glb.root["accessors"][1]["count"] = 18;
    const Scene scene = loaded(glb);
    EXPECT_EQ(scene.geometry->objects[0].indexCount, 12u);
    EXPECT_TRUE(warns(scene, "without area"));
    EXPECT_TRUE(warns(scene, "twice"));
}

}  // namespace
}  // namespace caustream::test
