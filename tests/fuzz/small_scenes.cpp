#include "small_scenes.h"

#include <algorithm>
#include <cstring>

#include "scenes/builtin.h"
#include "scenes/png.h"
#include "tests/unit/glb_editor.h"

namespace caustream::fuzz {
namespace {

using nlohmann::json;
using test::Glb;
using File = std::vector<std::uint8_t>;

constexpr std::size_t kElements = 12;  // of each accessor: four triangles

std::size_t componentBytes(int type) { return type == 5120 || type == 5121 ? 1 : type == 5122 || type == 5123 ? 2 : 4; }

std::size_t components(const std::string& type) { return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : 4; }

template <class T>
void wrapIndices(File& data, std::size_t vertices) {
    for (std::size_t at = 0; at + sizeof(T) <= data.size(); at += sizeof(T)) {
        T index;
        std::memcpy(&index, data.data() + at, sizeof index);
        index = static_cast<T>(index % vertices);
        std::memcpy(data.data() + at, &index, sizeof index);
    }
}

// The same file with the first elements of each accessor and pictures of one texel.
Glb shrunk(const Glb& whole) {
    Glb small;
    small.root = whole.root;
    for (const char* data : {"bufferViews", "accessors", "buffers"}) {
        small.root.erase(data);
    }
    for (const json& accessor : whole.root.value("accessors", json::array())) {
        const json& view = whole.root["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        const std::size_t count = std::min(accessor["count"].get<std::size_t>(), kElements);
        const int type = accessor["componentType"];
        const std::size_t bytes = count * components(accessor["type"]) * componentBytes(type);
        const auto begin = whole.binary.begin() + view.value("byteOffset", 0) + accessor.value("byteOffset", 0);
        File data(begin, begin + static_cast<std::ptrdiff_t>(bytes));
        if (accessor["type"] == "SCALAR") {
            type == 5125 ? wrapIndices<std::uint32_t>(data, kElements / 2) : wrapIndices<std::uint16_t>(data, kElements / 2);
        }
        json kept = accessor;
        kept.erase("byteOffset");
        kept["count"] = count;
        kept["bufferView"] = small.view(data);
        small.root["accessors"].push_back(kept);
    }
    for (json& image : small.root["images"]) {
        image["bufferView"] = small.view(scenes::encodePng(1, 1, {200, 150, 90}));
    }
    return small;
}

Glb textured(const json& image, const File& bytes) {
    Glb glb = test::triangle();
    glb.root["images"] = {image};
    if (!bytes.empty()) {
        glb.root["images"][0]["bufferView"] = glb.view(bytes);
    }
    glb.root["textures"] = {{{"source", 0}}};
    glb.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    glb.root["meshes"][0]["primitives"][0]["material"] = 0;
    return glb;
}

// What nobody's scene uses all at once: sparse values, strips, normalised integers, every light, spectra, a cookie.
Glb everything() {
    Glb glb = test::glassTetrahedron();
    const int bytes = glb.view(std::vector<std::int8_t>{0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 0}, 4);
    const int quantized = glb.accessor(bytes, 5120, 3, "VEC3");
    glb.root["accessors"][static_cast<std::size_t>(quantized)]["normalized"] = true;
    const int uv = glb.accessor(glb.view(std::vector<float>{0, 0, 1, 0, 0, 1}), 5126, 3, "VEC2");
    const int replaced = glb.view(std::vector<float>{0, 2, 0});
    const int where = glb.view(std::vector<std::uint16_t>{2});
    glb.root["accessors"][0]["sparse"] = {
        {"count", 1}, {"indices", {{"bufferView", where}, {"componentType", 5123}}}, {"values", {{"bufferView", replaced}}}};
    glb.root["images"] = {{{"mimeType", "image/png"}, {"bufferView", glb.view(scenes::encodePng(2, 1, {1, 2, 3, 4, 5, 6}))}}};
    glb.root["textures"] = {{{"source", 0}}};
    glb.root["materials"].push_back(
        {{"pbrMetallicRoughness",
          {{"baseColorTexture",
            {{"index", 0},
             {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}, {"scale", {2, 2}}, {"rotation", 1}, {"texCoord", 0}}}}}}}}}});
    for (const int mode : {5, 6}) {
        glb.root["meshes"][0]["primitives"].push_back(
            {{"attributes", {{"POSITION", quantized}, {"NORMAL", quantized}, {"TEXCOORD_0", uv}}}, {"mode", mode}, {"material", 1}});
    }
    glb.root["materials"][0]["extras"]["caustream"] = {{"cauchy", {1.5, 0.01}}, {"absorption", {{380, 680}, {1, 2}}}, {"priority", 2}};
    glb.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"},
         {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}},
         {"extras", {{"caustream", {{"spectrum", {"lines", 450, 589.3}}, {"cookie", 0}}}}}},
        {{"type", "point"}, {"intensity", 5}, {"extras", {{"caustream", {{"spectrum", {"blackbody", 3000}}}}}}},
        {{"type", "directional"}, {"color", {1, 0.5, 0.25}}, {"extras", {{"caustream", {{"spectrum", {"D65"}}}}}}}};
    for (const int light : {0, 1, 2}) {
        glb.root["nodes"].push_back({{"translation", {0, light + 1, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    }
    glb.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}},
                           {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 9}, {"znear", 0.1}}}}};
    glb.root["nodes"].push_back({{"camera", 0}, {"rotation", {0, 0.7, 0, 0.7}}, {"extras", {{"caustream", {{"target", {0, 0, 0}}}}}}});
    glb.root["nodes"].push_back({{"camera", 1}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 3, 1}}});
    glb.root["nodes"].push_back({{"children", {1, 2, 3, 4, 5}}, {"scale", {1, -1, 1}}});
    glb.root["scenes"] = {{{"nodes", {0, 6}},
                           {"extras", {{"caustream", {{"environment", {0.1, 0.1, 0.1}}, {"exposure_bias_ev", 1}, {"outside_index", 1.33}}}}}}};
    return glb;
}

Glb nodeChain(int length) {
    Glb glb = test::triangle();
    for (int i = 0; i < length; ++i) {
        glb.root["nodes"][static_cast<std::size_t>(i)]["children"] = {i + 1};
        glb.root["nodes"].push_back({{"mesh", 0}});
    }
    return glb;
}

// A PNG whose header promises far more than its data holds.
File hugePng() {
    File png = scenes::encodePng(1, 1, {1, 2, 3});
    const std::uint8_t side[] = {0, 1, 0x86, 0xA0};  // 100000
    std::copy(std::begin(side), std::end(side), png.begin() + 16);
    std::copy(std::begin(side), std::end(side), png.begin() + 20);
    return png;
}

}  // namespace

std::map<std::string, std::vector<std::uint8_t>> smallScenes() {
    std::map<std::string, File> files;
    for (const char* name : {"gem", "sphere", "ring", "glass", "prism", "brilliant", "emerald", "water", "jewel", "newton", "ball"}) {
        files[name] = shrunk(test::unpack(scenes::makeBuiltin(name))).pack();
    }
    files["everything"] = everything().pack();
    files["tetrahedron"] = test::glassTetrahedron().pack();
    files["triangle"] = test::triangle().pack();
    files["png"] = textured({{"mimeType", "image/png"}}, scenes::encodePng(2, 2, File(12, 99))).pack();
    files["png_that_promises"] = textured({{"mimeType", "image/png"}}, hugePng()).pack();
    files["data_uri"] = textured({{"uri", "data:image/png;base64,iVBORw0KGgo="}}, {}).pack();
    files["outside_file"] = textured({{"uri", "../../secret.png"}}, {}).pack();
    files["node_chain"] = nodeChain(100).pack();
    files["node_cycle"] = nodeChain(3).pack();
    Glb cycle = nodeChain(3);
    cycle.root["nodes"][3]["children"] = {1};
    files["node_cycle"] = cycle.pack();
    Glb zeros = test::triangle();
    zeros.root["accessors"][0].erase("bufferView");
    zeros.root["accessors"][0]["count"] = 50'000;
    files["zeros_of_nothing"] = zeros.pack();
    Glb buffer = test::triangle();
    buffer.root["buffers"] = {{{"uri", "data:application/octet-stream;base64,AAAAAAAAgD8AAAAAAACAPwAAAAA="}, {"byteLength", 20}}};
    files["data_buffer"] = buffer.pack();
    return files;
}

}  // namespace caustream::fuzz
