#include "tests/reference/reference.h"

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "scenes/glb_writer.h"
#include "scenes/mesh.h"

namespace caustream::reference {

using nlohmann::json;

namespace {

const std::string kFolder = CAUSTREAM_REFERENCE_DIR;

json readJson(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot open " + path);
    return json::parse(file);
}

scenes::Mesh casterMesh(const json& object, int sphereLevels) {
    if (object.at("type") == "sphere") {
        const auto centre = object.at("centre").get<std::array<double, 3>>();
        return scenes::icosphere(sphereLevels, {centre[0], centre[1], centre[2]}, object.at("radius").get<double>());
    }
    std::vector<glm::dvec4> planes;
    for (const json& plane : object.at("planes_outward_normal_and_offset_n_dot_x_le_d")) {
        const auto p = plane.get<std::array<double, 4>>();
        planes.emplace_back(p[0], p[1], p[2], p[3]);
    }
    return scenes::convexPolyhedron(planes);
}

}  // namespace

std::string sceneFile(const std::string& name) { return kFolder + "/" + name + ".json"; }

Reference load(const std::string& name) {
    Reference reference;
    reference.json = readJson(sceneFile(name));
    const json& window = reference.json.at("window");
    reference.window = {window.at("x0"), window.at("z0"), window.at("width"), window.at("cells")};
    const json& light = reference.json.at("light");
    reference.lightPosition = light.at("position").get<std::array<double, 3>>();
    reference.halfAngleDeg = light.at("half_angle_deg");
    for (const json& band : reference.json.at("files").at(name + "_mono7.npy").at("per_wavelength")) {
        reference.nm.push_back(band.at("nm"));
        reference.windowFlux.push_back(band.at("flux_window_W"));
    }
    reference.mono7 = npy::read(kFolder + "/" + name + "_mono7.npy.gz");
    reference.direct = npy::read(kFolder + "/" + name + "_direct.npy.gz");
    const std::string xyz = kFolder + "/" + name + "_xyz.npy.gz";
    if (std::filesystem::exists(xyz)) reference.xyz = npy::read(xyz);
    return reference;
}

std::vector<std::uint8_t> makeGlb(const Reference& reference, int sphereLevels) {
    const json& glass = reference.json.at("glass");
    const double A = glass.at("A"), B = glass.at("B_um2");
    const json& absorption = glass.at("absorption_per_unit_length");
    const json perM = {absorption.at("at380nm"), absorption.at("at680nm")};
    json extras{{"cauchy", {A, B}}};
    if (perM[0].get<double>() > 0.0 || perM[1].get<double>() > 0.0) extras["absorption"] = {{380.0, 680.0}, perM};

    scenes::GlbWriter glb;
    const int caster = glb.addMaterial(scenes::glassMaterial("glass", A + B / (0.58756 * 0.58756), extras));
    const int white = glb.addMaterial(scenes::matteMaterial("floor", {0.8f, 0.8f, 0.8f}));
    glb.addMesh("caster", casterMesh(reference.json.at("object"), sphereLevels), caster);
    constexpr float kHalf = 10.0f;
    glb.addMesh("floor", scenes::quad({-kHalf, 0, kHalf}, {kHalf, 0, kHalf}, {kHalf, 0, -kHalf}, {-kHalf, 0, -kHalf}),
                white);

    const auto aim = reference.json.at("light").at("aim_point").get<std::array<double, 3>>();
    const auto& from = reference.lightPosition;
    glb.addLight(scenes::spotLight("key", 1.0, reference.halfAngleDeg, reference.halfAngleDeg),
                 {from[0], from[1], from[2]}, {aim[0], aim[1], aim[2]});
    const Window& w = reference.window;
    const glm::dvec3 middle(w.x0 + 0.5 * w.width, 0.0, w.z0 + 0.5 * w.width);
    glb.addCamera("camera", middle + glm::dvec3(0.0, 2.0 * w.width, 1.5 * w.width), middle, 40.0);
    return glb.finish();
}

}  // namespace caustream::reference
