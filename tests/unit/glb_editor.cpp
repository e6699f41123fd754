#include "glb_editor.h"

#include <cstring>

namespace caustream::test {

namespace {

void putWord(std::vector<std::uint8_t>& bytes, std::size_t word) {
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
}

std::size_t wordAt(std::span<const std::uint8_t> bytes, std::size_t offset) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, 4);
    return word;
}

}  // namespace

int Glb::viewOf(const void* data, std::size_t bytes, int stride) {
    binary.resize((binary.size() + 3) / 4 * 4, 0);
    json entry{{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes}};
    if (stride > 0) entry["byteStride"] = stride;
    root["bufferViews"].push_back(entry);
    const auto* begin = static_cast<const std::uint8_t*>(data);
    binary.insert(binary.end(), begin, begin + bytes);
    return static_cast<int>(root["bufferViews"].size()) - 1;
}

int Glb::accessor(int view, int componentType, std::size_t count, const char* type, std::size_t byteOffset) {
    root["accessors"].push_back({{"bufferView", view},
                                 {"componentType", componentType},
                                 {"count", count},
                                 {"type", type},
                                 {"byteOffset", byteOffset}});
    return static_cast<int>(root["accessors"].size()) - 1;
}

std::vector<std::uint8_t> Glb::pack() const {
    json whole = root;
    if (!binary.empty() && !whole.contains("buffers")) whole["buffers"] = {{{"byteLength", binary.size()}}};
    return packText(whole.dump(), binary);
}

std::vector<std::uint8_t> packText(std::string text, const std::vector<std::uint8_t>& binary) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<std::uint8_t> padded = binary;
    padded.resize((padded.size() + 3) / 4 * 4, 0);
    std::vector<std::uint8_t> file;
    putWord(file, 0x46546C67);
    putWord(file, 2);
    putWord(file, 12 + 8 + text.size() + (padded.empty() ? 0 : 8 + padded.size()));
    putWord(file, text.size());
    putWord(file, 0x4E4F534A);
    file.insert(file.end(), text.begin(), text.end());
    if (padded.empty()) return file;
    putWord(file, padded.size());
    putWord(file, 0x004E4942);
    file.insert(file.end(), padded.begin(), padded.end());
    return file;
}

Glb unpack(std::span<const std::uint8_t> file) {
    Glb glb;
    const std::size_t jsonSize = wordAt(file, 12);
    glb.root = json::parse(file.begin() + 20, file.begin() + static_cast<std::ptrdiff_t>(20 + jsonSize));
    const std::size_t binSize = wordAt(file, 20 + jsonSize);
    const auto bin = file.subspan(28 + jsonSize, binSize);
    glb.binary.assign(bin.begin(), bin.end());
    return glb;
}

Glb triangle() {
    Glb glb;
    glb.root["asset"]["version"] = "2.0";
    const int positions = glb.view(std::vector<float>{0, 0, 0, 0, 0, 1, 1, 0, 0});
    glb.accessor(positions, 5126, 3, "VEC3");
    glb.root["meshes"] = {{{"name", "triangle"}, {"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}};
    glb.root["nodes"] = {{{"mesh", 0}}};
    glb.root["scenes"] = {{{"nodes", {0}}}};
    glb.root["scene"] = 0;
    return glb;
}

Glb glassTetrahedron() {
    Glb glb;
    glb.root["asset"]["version"] = "2.0";
    const int positions = glb.view(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
    glb.accessor(positions, 5126, 4, "VEC3");
    const int indices = glb.view(std::vector<std::uint16_t>{0, 2, 1, 0, 3, 2, 0, 1, 3, 1, 2, 3});
    glb.accessor(indices, 5123, 12, "SCALAR");
    glb.root["materials"] = {{{"name", "glass"},
                              {"extensions",
                               {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}},
                                {"KHR_materials_volume", {{"thicknessFactor", 1.0}}}}}}};
    json primitive{{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"material", 0}};
    glb.root["meshes"] = {{{"name", "tetrahedron"}, {"primitives", {primitive}}}};
    glb.root["nodes"] = {{{"mesh", 0}, {"name", "stone"}}};
    glb.root["scenes"] = {{{"nodes", {0}}}};
    glb.root["scene"] = 0;
    return glb;
}

tl::expected<scene::Scene, scene::LoadError> load(std::span<const std::uint8_t> file, const scene::LoadLimits& limits) {
    return scene::loadGlb(std::as_bytes(file), "test", limits);
}

tl::expected<scene::Scene, scene::LoadError> load(const Glb& glb) {
    const std::vector<std::uint8_t> file = glb.pack();
    return load(file);
}

bool warns(const scene::Scene& scene, const std::string& part) {
    for (const std::string& warning : scene.warnings)
        if (warning.find(part) != std::string::npos) return true;
    return false;
}

}  // namespace caustream::test
