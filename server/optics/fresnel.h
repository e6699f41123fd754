// Snell and Fresnel at a smooth dielectric interface, double precision.
#pragma once
#include <glm/vec3.hpp>
#include <optional>

namespace caustream::optics {

// Unpolarised reflectance (Fresnel 1823) for the cosine of incidence `cosI` in [0, 1]; eta = n_i / n_t. 1 at total
// internal reflection.
double fresnelDielectric(double cosI, double eta);

// Snell: unit direction `d` (towards the surface) meets unit normal `n` (against d). Nothing at total reflection.
std::optional<glm::dvec3> refract(const glm::dvec3& d, const glm::dvec3& n, double eta);

}  // namespace caustream::optics
