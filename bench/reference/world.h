// What the reference tracer traces through: double precision, lengths in metres, right-handed, Y up. Nothing here is shared
// with the renderer but the data types of glasses and spectra.
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <variant>
#include <vector>

#include "optics/absorption.h"
#include "optics/dispersion.h"
#include "optics/spectrum.h"
#include "scene/scene.h"

namespace caustream::tracer {

struct Glass {
    optics::Dispersion dispersion;
    optics::Absorption absorption;
    int priority = 0;       // where bodies overlap the highest is what is there; of equal ones the first, solids last
    bool mirror = false;    // opaque metal that reflects, from both sides; its reflectance is what `absorption` leaves over 1 m
};

struct Body {  // triangles, counter-clockwise seen from outside
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> normals;     // unit, one a position: what light refracts and reflects at
    std::vector<std::uint32_t> indices;  // three a triangle
    int glass = -1;                      // index into World::glasses; -1: opaque, a receiver
};

struct Sphere {
    glm::dvec3 centre{0.0};
    double radius = 1.0;
};
struct ConvexPlanes {  // the points with dot(xyz, p) <= w for every plane; xyz unit, outwards
    std::vector<glm::dvec4> planes;
};
struct Solid {  // exact surfaces instead of triangles; always glass
    std::variant<Sphere, ConvexPlanes> shape;
    int glass = 0;
};

struct Cookie {  // linear luminance, rows top to bottom; spans the outer cone's square (docs/units.md)
    int width = 0, height = 0;
    std::vector<double> luminance;
};

struct Light {
    scene::LightType type = scene::LightType::Spot;
    glm::dvec3 position{0.0};
    glm::dvec3 direction{0, -1, 0};  // unit, the way the light travels
    double innerConeRad = 0.0, outerConeRad = 0.7854;  // half angles, Spot only; equal: a hard edge
    optics::Spectrum spectrum;       // weighs the continuous spectrum
    Cookie cookie;                   // none when empty
};

struct World {
    std::vector<Glass> glasses;
    std::vector<Body> bodies;
    std::vector<Solid> solids;
    Light light;
    double outsideIndex = 1.0;
};

// Thin-walled casters bend nothing. Receivers: they stop light as anything opaque does. Absent: light passes them
// unchanged, as it passes them in the renderer's light passes.
enum class ThinWalls { Receivers, Absent };

// Smooth metal throws light, as it does, or only stops it, as it does in the renderer's refined and thesis modes.
enum class Mirrors { Casters, Receivers };

// A loaded scene under one of its lights.
World worldOf(const scene::Scene& scene, const scene::Light& light, ThinWalls thinWalls = ThinWalls::Receivers,
              Mirrors mirrors = Mirrors::Casters);

// A scene of tests/reference/*.json ("prism.json"): the exact solid, a floor of 2 km, the light. Throws
// std::runtime_error that names the file.
World worldOfJson(const std::string& file);

}  // namespace caustream::tracer
