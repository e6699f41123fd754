// Low-discrepancy places for an endless row of photons: any run of them is spread evenly, and so are runs together.
// Roberts 2018, The Unreasonable Effectiveness of Quasirandom Sequences: R2 for the direction and the golden ratio for the
// wavelength, in 32-bit fixed point, so that the place of a photon depends on its number alone.
const float kLatticeUnit = 1.0 / 16777216.0;

vec2 latticeDirection(uint photon) {
    uvec2 at = uvec2(3242174889u, 2447445414u) * photon + 0x80000000u;   // 2^32 / p, / p^2; p^3 = p + 1
    return (vec2(at >> 8) + 0.5) * kLatticeUnit;
}

float latticeWavelength(uint photon) {
    return (float((2654435769u * photon + 0x80000000u) >> 8) + 0.5) * kLatticeUnit;   // 2^32 / golden ratio
}
