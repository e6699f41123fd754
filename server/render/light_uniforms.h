// Uniforms of shaders/common/lights.glsl.
#pragma once
#include <glm/vec3.hpp>
#include <string>

#include "gl/uniforms.h"
#include "render/lighting.h"

namespace caustream::render {

// What 1.0 in a camera image stands for: the radiance of a white receiver under the reference irradiance,
// W m^-2 sr^-1 (or cd m^-2). Keeps half floats in range whatever the lights' scale; never 0.
float radianceUnit(const Lighting& lighting);

// From candela (or lux) to the shaders' unit: irradiance over the reference irradiance.
float irradianceScale(const Lighting& lighting);

// Sets the members of a GLSL `uniform Light <name>`; position and direction as they are in `light`, `rgb` its colour.
void setLight(const gl::Uniforms& uniforms, const std::string& name, const scene::Light& light, const glm::vec3& rgb);

}  // namespace caustream::render
