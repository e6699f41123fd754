// What a scene is, once loaded: world-space triangles in one vertex and one index array, objects that are ranges of them,
// materials, lights, cameras. Lengths in metres, right-handed, Y up. Immutable after loading; no GL.
#pragma once
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <string>
#include <vector>

#include "optics/absorption.h"
#include "optics/dispersion.h"
#include "optics/spectrum.h"

namespace caustream::scene {

struct Vertex {  // node transforms are baked in
    glm::vec3 position;
    glm::vec3 normal;  // unit; flat where the file had none
    glm::vec2 uv{0.0f};
};

struct Bounds {
    glm::vec3 min{3.0e38f}, max{-3.0e38f};
    bool empty() const { return min.x > max.x; }
    glm::vec3 centre() const { return 0.5f * (min + max); }
    float radius() const;                       // of the sphere around centre(); 0 when empty
    void add(const glm::vec3& point);
    void add(const Bounds& other);
};

struct Texture {  // 8-bit sRGB RGBA, rows top to bottom as glTF stores them (uv origin top left)
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

struct Material {
    std::string name;                 // unique in the scene
    bool caster = false;              // transmissive: light goes through it
    optics::Dispersion dispersion;    // casters only
    optics::Absorption absorption;    // casters only
    bool thinWalled = false;          // KHR_materials_volume thickness 0: no refraction
    bool mirror = false;              // metal and smooth, never a caster too: throws light in traced mode, is a receiver in the others
    int priority = 0;                 // casters only: where they overlap, the highest is what is there (docs/units.md)
    glm::vec4 baseColor{1.0f};        // linear; tints what a thin-walled caster lets through
    int baseColorTexture = -1;        // index into Scene::textures
    float roughness = 1.0f, metallic = 0.0f;
    glm::vec3 emissive{0.0f};         // W m^-2 sr^-1 as glTF's emissiveFactor; shown, lights nothing
    bool doubleSided = false;
};

struct Object {                       // one draw: a material and a range of Scene::indices
    std::string name;
    int material = 0;
    std::uint32_t firstIndex = 0, indexCount = 0;
    Bounds bounds;
};

enum class LightType { Spot, Point, Directional };

struct Light {
    std::string name;                 // unique in the scene
    LightType type = LightType::Spot;
    glm::vec3 position{0.0f};         // m; meaningless for Directional
    glm::vec3 direction{0, -1, 0};    // unit, the way the light travels (the axis of a spot); Point: towards the casters
    float innerConeDeg = 0.0f;        // half angles, Spot only; intensity falls off between them as glTF says,
    float outerConeDeg = 45.0f;       //   inner == outer is a hard edge
    float intensity = 100.0f;         // cd on the axis (Spot, Point) or lx (Directional)
    glm::vec3 color{1.0f};            // linear BT.709, glTF's colour; multiplies the spectrum's own
    optics::Spectrum spectrum;
    int cookie = -1;                  // index into Scene::textures: multiplies the cone, spans the outer cone's square
};

struct Camera {
    std::string name;
    glm::vec3 eye{0, 1, 3}, target{0}, up{0, 1, 0};
    float fovYDeg = 40.0f;
};

struct Geometry {                     // what the GPU and the tracer cache by pointer
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;  // triangles, counter-clockwise seen from outside
    std::vector<Object> objects;
    std::vector<Texture> textures;
    Bounds bounds;                    // of everything
    Bounds casterBounds;              // of the objects whose material is a caster; may be empty
};

struct Scene {
    std::string name;                 // of the built-in scene, or the file's name or hash
    std::shared_ptr<const Geometry> geometry;
    std::vector<Material> materials;  // referenced by Object::material
    std::vector<Light> lights;        // never empty after loading: one is placed if the file has none
    std::vector<Camera> cameras;      // likewise; cameras[0] is the one to start with
    glm::vec3 environmentColor{0.05f};// linear, radiance relative to a white receiver under the key light
    float exposureBiasEv = 0.0f;      // stops added to the automatic exposure: a rainbow is dimmer than its beam
    double outsideIndex = 1.0;        // refractive index around the casters
    std::vector<std::string> warnings;// a sentence each, for the person who loads the file
};

}  // namespace caustream::scene
