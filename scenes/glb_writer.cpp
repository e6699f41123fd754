#include "scenes/glb_writer.h"

#include <algorithm>

#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

namespace caustream::scenes {

using nlohmann::json;

namespace {

constexpr int kFloat = 5126, kUnsignedInt = 5125;
constexpr std::uint32_t kGlbMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

double radians(double degrees) {
    return degrees * std::numbers::pi / 180.0;
}

json vector3(const glm::dvec3& v) {
    return json::array({v.x, v.y, v.z});
}

// A node at `position` whose -Z looks at `target`.
json lookingAt(const glm::dvec3& position, const glm::dvec3& target) {
    const glm::dvec3 forward = glm::normalize(target - position);
    const glm::dvec3 up = std::abs(forward.y) > 0.999 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
    const glm::dquat turn = glm::quatLookAtRH(forward, up);
    return {{"translation", vector3(position)}, {"rotation", {turn.x, turn.y, turn.z, turn.w}}};
}

void putWord(std::vector<std::uint8_t>& bytes, std::size_t word) {
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
}

}  // namespace

GlbWriter::GlbWriter() {
    json_["asset"] = {{"version", "2.0"}, {"generator", "caustream make_scenes"}};
    json_["scene"] = 0;
    json_["scenes"] = {{{"nodes", json::array()}}};
}

int GlbWriter::addMaterial(json material) {
    if (material.contains("extensions"))
        for (const auto& [name, value] : material["extensions"].items()) use(name);
    json_["materials"].push_back(std::move(material));
    return static_cast<int>(json_["materials"].size()) - 1;
}

int GlbWriter::addTexture(std::span<const std::uint8_t> png) {
    json_["images"].push_back({{"bufferView", addView(png.data(), png.size())}, {"mimeType", "image/png"}});
    json_["textures"].push_back({{"source", json_["images"].size() - 1}});
    return static_cast<int>(json_["textures"].size()) - 1;
}

void GlbWriter::addMesh(const std::string& name, const Mesh& mesh, int material) {
    json attributes;
    const std::size_t count = mesh.positions.size();
    attributes["POSITION"] = addAccessor(mesh.positions.data(), count, sizeof(glm::vec3), kFloat, "VEC3");
    glm::vec3 lo = mesh.positions.at(0), hi = lo;
    for (const glm::vec3& p : mesh.positions) lo = glm::min(lo, p), hi = glm::max(hi, p);
    json_["accessors"].back()["min"] = {lo.x, lo.y, lo.z};
    json_["accessors"].back()["max"] = {hi.x, hi.y, hi.z};
    if (!mesh.normals.empty())
        attributes["NORMAL"] = addAccessor(mesh.normals.data(), count, sizeof(glm::vec3), kFloat, "VEC3");
    if (!mesh.uvs.empty())
        attributes["TEXCOORD_0"] = addAccessor(mesh.uvs.data(), count, sizeof(glm::vec2), kFloat, "VEC2");
    const int indices = addAccessor(mesh.indices.data(), mesh.indices.size(), 4, kUnsignedInt, "SCALAR");

    json primitive{{"attributes", attributes}, {"indices", indices}, {"material", material}};
    json_["meshes"].push_back({{"name", name}, {"primitives", {primitive}}});
    addNode({{"name", name}, {"mesh", json_["meshes"].size() - 1}});
}

void GlbWriter::addLight(json light, const glm::dvec3& position, const glm::dvec3& target) {
    use("KHR_lights_punctual");
    json& lights = json_["extensions"]["KHR_lights_punctual"]["lights"];
    json node = lookingAt(position, target);
    node["name"] = light.value("name", "light");
    lights.push_back(std::move(light));
    node["extensions"]["KHR_lights_punctual"]["light"] = lights.size() - 1;
    addNode(std::move(node));
}

void GlbWriter::addCamera(const std::string& name, const glm::dvec3& eye, const glm::dvec3& target, double fovYDeg) {
    json_["cameras"].push_back(
        {{"name", name}, {"type", "perspective"}, {"perspective", {{"yfov", radians(fovYDeg)}, {"znear", 0.01}}}});
    json node = lookingAt(eye, target);
    node["name"] = name;
    node["camera"] = json_["cameras"].size() - 1;
    // glTF has no target: extras keep it, so that orbiting turns around what the picture is about.
    node["extras"]["caustream"]["target"] = vector3(target);
    addNode(std::move(node));
}

void GlbWriter::setSceneExtras(json extras) {
    json_["scenes"][0]["extras"]["caustream"] = std::move(extras);
}

std::vector<std::uint8_t> GlbWriter::finish() const {
    json root = json_;
    std::vector<std::uint8_t> binary = binary_;
    root["buffers"] = {{{"byteLength", binary.size()}}};
    std::string text = root.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, 0);

    std::vector<std::uint8_t> file;
    putWord(file, kGlbMagic);
    putWord(file, 2);
    putWord(file, 12 + 8 + text.size() + 8 + binary.size());
    putWord(file, text.size());
    putWord(file, kJsonChunk);
    file.insert(file.end(), text.begin(), text.end());
    putWord(file, binary.size());
    putWord(file, kBinChunk);
    file.insert(file.end(), binary.begin(), binary.end());
    return file;
}

int GlbWriter::addView(const void* data, std::size_t bytes) {
    binary_.resize((binary_.size() + 3) / 4 * 4, 0);
    json_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes}});
    const auto* begin = static_cast<const std::uint8_t*>(data);
    binary_.insert(binary_.end(), begin, begin + bytes);
    return static_cast<int>(json_["bufferViews"].size()) - 1;
}

int GlbWriter::addAccessor(const void* data, std::size_t count, std::size_t stride, int componentType,
                           const char* type) {
    const int view = addView(data, count * stride);
    json_["accessors"].push_back(
        {{"bufferView", view}, {"componentType", componentType}, {"count", count}, {"type", type}});
    return static_cast<int>(json_["accessors"].size()) - 1;
}

void GlbWriter::addNode(json node) {
    json_["nodes"].push_back(std::move(node));
    json_["scenes"][0]["nodes"].push_back(json_["nodes"].size() - 1);
}

void GlbWriter::use(const std::string& extension) {
    json& used = json_["extensionsUsed"];
    if (std::find(used.begin(), used.end(), extension) == used.end()) used.push_back(extension);
}

json glassMaterial(const std::string& name, double ior, json extras) {
    json material{{"name", name}, {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.0}}}};
    material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1.0;
    material["extensions"]["KHR_materials_ior"]["ior"] = ior;
    material["extensions"]["KHR_materials_volume"]["thicknessFactor"] = 1.0;
    if (!extras.is_null()) material["extras"]["caustream"] = std::move(extras);
    return material;
}

json matteMaterial(const std::string& name, const glm::vec3& color) {
    return {
        {"name", name},
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {color.r, color.g, color.b, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 1.0}}}};
}

json metalMaterial(const std::string& name, const glm::vec3& color) {
    return {
        {"name", name},
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {color.r, color.g, color.b, 1.0}}, {"metallicFactor", 1.0}, {"roughnessFactor", 0.1}}}};
}

json spotLight(const std::string& name, double candela, double innerDeg, double outerDeg) {
    return {{"name", name},
            {"type", "spot"},
            {"intensity", candela},
            {"spot", {{"innerConeAngle", radians(innerDeg)}, {"outerConeAngle", radians(outerDeg)}}}};
}

}  // namespace caustream::scenes
