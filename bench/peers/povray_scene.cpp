#include "bench/peers/povray_scene.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace caustream::peers {

namespace {

using nlohmann::json;
using reference::Reference;

constexpr int kTraceLevel = 17;          // an entry and sixteen meetings from within, as the reference maps have
constexpr double kWeakest = 1e-3;        // adc_bailout: POV-Ray's default for photons, for rays, too
// With fade_distance d and fade_power 2 POV-Ray's light is 2 / (1 + (r / d)^2): an inverse square law where r >> d.
constexpr double kFadeDistance = 1e-3;
constexpr double kLevel = 0.25;          // of irradiance 1 in the picture, so that no focus clips

std::string vector(const json& v) {
    std::ostringstream text;
    text.precision(17);
    text << '<' << v[0].get<double>() << ',' << v[1].get<double>() << ',' << v[2].get<double>() << '>';
    return text.str();
}

void addSurroundings(std::ostream& out, const Reference& reference) {
    const reference::Window& w = reference.window;
    const json& light = reference.json.at("light");
    // Rows run along +z from the top. Below the caster, above the floor.
    out << "camera { orthographic location <" << w.x0 + 0.5 * w.width << ",0.05," << w.z0 + 0.5 * w.width << "> direction <0,-1,0> right <"
        << w.width << ",0,0> up <0,0," << -w.width << "> }\n"
        << "light_source { " << vector(light.at("position")) << " rgb " << kLevel / (2.0 * kFadeDistance * kFadeDistance) << " spotlight point_at "
        << vector(light.at("aim_point")) << " radius " << reference.halfAngleDeg << " falloff " << reference.halfAngleDeg
        << " tightness 0 fade_power 2 fade_distance " << kFadeDistance << " photons { refraction on reflection on } }\n"
        << "plane { y, 0 pigment { rgb 1 } finish { ambient 0 diffuse 1 } }\n";
}

// An object up to its pigment.
void addShape(std::ostream& out, const json& object, const scene::Bounds& caster) {
    if (object.at("type") == "sphere") {
        out << "sphere { " << vector(object.at("centre")) << ", " << object.at("radius").get<double>() << '\n';
        return;
    }
    out << "intersection {\n";
    for (const json& plane : object.at("planes_outward_normal_and_offset_n_dot_x_le_d")) out << "  plane { " << vector(plane) << ", " << plane[3].get<double>() << " }\n";
    // POV-Ray aims photons at the bounds; those that it finds for planes are endless.
    const glm::vec3 centre = caster.centre();
    out << "  bounded_by { sphere { <" << centre.x << ',' << centre.y << ',' << centre.z << ">, " << 1.001f * caster.radius() << " } }\n";
}

std::ostringstream begin() {
    std::ostringstream out;
    out.precision(12);
    out << "#version 3.7;\n";
    return out;
}

}  // namespace

std::string povrayScene(const Reference& reference, const scene::Bounds& caster, double nm, const PovrayPhotons& photons) {
    const json& glass = reference.json.at("glass");
    const double micrometres = nm / 1000.0;
    const double index = glass.at("A").get<double>() + glass.at("B_um2").get<double>() / (micrometres * micrometres);
    const json& absorption = glass.at("absorption_per_unit_length");
    const double perM = std::lerp(absorption.at("at380nm").get<double>(), absorption.at("at680nm").get<double>(), (nm - 380.0) / 300.0);

    std::ostringstream out = begin();
    out << "global_settings { assumed_gamma 1.0 ambient_light 0 max_trace_level " << kTraceLevel << " adc_bailout " << kWeakest
        << " photons { count " << photons.count << " autostop 0 jitter 0 gather " << photons.gatherLeast << ", " << photons.gatherMost
        << " max_trace_level " << kTraceLevel << " adc_bailout " << kWeakest << " } }\n";
    addSurroundings(out, reference);
    addShape(out, reference.json.at("object"), caster);
    out << "  pigment { rgbt 1 } finish { ambient 0 diffuse 0 reflection { 0, 1 fresnel on } conserve_energy }\n"
        << "  interior { ior " << index;
    if (perM > 0.0) out << " fade_power 1001 fade_distance " << 1.0 / perM << " fade_color rgb 0";   // 1001: exponential
    out << " }\n  photons { target refraction on reflection on collect off } }\n";
    return out.str();
}

std::string povrayDirectScene(const Reference& reference, const scene::Bounds& caster) {
    std::ostringstream out = begin();
    out << "global_settings { assumed_gamma 1.0 ambient_light 0 }\n";
    addSurroundings(out, reference);
    addShape(out, reference.json.at("object"), caster);
    out << "  pigment { rgb 0 } finish { ambient 0 diffuse 0 } }\n";
    return out.str();
}

}  // namespace caustream::peers
