// Glass and its surface, written from the formulas: index, absorption, Snell, Fresnel.
#pragma once
#include <glm/vec3.hpp>

#include "optics/absorption.h"
#include "optics/dispersion.h"

namespace caustream::tracer {

// Refractive index at a wavelength in nm.
double indexAt(const optics::Dispersion& dispersion, double nm);

// sigma in 1/m at a wavelength in nm: linear in the table, constant beyond it.
double absorptionAt(const optics::Absorption& absorption, double nm);

struct Split {
    double reflectance = 1.0;     // unpolarised, 0..1; exactly 0 between equal indices, 1 at total reflection
    glm::dvec3 reflected{0.0};    // unit
    glm::dvec3 transmitted{0.0};  // unit; meaningless at total reflection
};

// Unit `d` meets a surface of unit normal `n` (dot(d, n) < 0) from index `nFrom` into `nInto`.
Split meet(const glm::dvec3& d, const glm::dvec3& n, double nFrom, double nInto);

}  // namespace caustream::tracer
