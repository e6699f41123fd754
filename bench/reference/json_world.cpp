// Reads the scenes of tests/reference: what their JSON says, without a mesh in between.
#include <array>
#include <fstream>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

#include "bench/reference/world.h"

namespace caustream::tracer {

namespace {

using nlohmann::json;

glm::dvec3 vec3(const json& value) {
    const auto v = value.get<std::array<double, 3>>();
    return {v[0], v[1], v[2]};
}

World read(const json& file) {
    World world;
    const json& glass = file.at("glass");
    const json& absorption = glass.at("absorption_per_unit_length");
    world.glasses.push_back({optics::Cauchy{glass.at("A"), glass.at("B_um2"), 0.0},
                             {{optics::kBandMinNm, optics::kBandMaxNm}, {absorption.at("at380nm"), absorption.at("at680nm")}}});
    const json& object = file.at("object");
    if (object.at("type") == "sphere") {
        world.solids.push_back({Sphere{vec3(object.at("centre")), object.at("radius")}, 0});
    } else {
        ConvexPlanes solid;
        for (const json& plane : object.at("planes_outward_normal_and_offset_n_dot_x_le_d")) {
            const auto p = plane.get<std::array<double, 4>>();
            solid.planes.emplace_back(p[0], p[1], p[2], p[3]);
        }
        world.solids.push_back({std::move(solid), 0});
    }
    constexpr double kHalfM = 1000.0;
    Body floor{.positions = {{-kHalfM, 0, kHalfM}, {kHalfM, 0, kHalfM}, {kHalfM, 0, -kHalfM}, {-kHalfM, 0, -kHalfM}},
               .normals = std::vector<glm::dvec3>(4, {0, 1, 0}),
               .indices = {0, 1, 2, 0, 2, 3}};
    world.bodies.push_back(std::move(floor));

    const json& light = file.at("light");
    world.light.position = vec3(light.at("position"));
    world.light.direction = glm::normalize(vec3(light.at("aim_point")) - world.light.position);
    world.light.outerConeRad = light.at("half_angle_deg").get<double>() * std::numbers::pi / 180.0;
    world.light.innerConeRad = world.light.outerConeRad;
    return world;
}

}  // namespace

World worldOfJson(const std::string& file) {
    std::ifstream stream(file);
    if (!stream) throw std::runtime_error("cannot open " + file);
    try {
        return read(json::parse(stream));
    } catch (const json::exception& error) {
        throw std::runtime_error(file + " is not a reference scene: " + error.what());
    }
}

}  // namespace caustream::tracer
