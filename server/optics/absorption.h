// Beer-Lambert absorption coefficient over wavelength.
#pragma once
#include <glm/vec3.hpp>
#include <vector>

namespace caustream::optics {

// sigma(l) in 1/m at the wavelengths `nm` (ascending), linear between, constant outside. Empty: no absorption.
struct Absorption {
    std::vector<double> nm;
    std::vector<double> perM;

    double at(double wavelengthNm) const;
    bool empty() const { return nm.empty(); }
};

// KHR_materials_volume: a spectrum of sigma that under white light over `distanceM` gives `attenuationColor` back
// (linear BT.709, each in (0, 1]). An infinite distance or white gives an empty table.
Absorption absorptionFromRgb(const glm::dvec3& attenuationColor, double distanceM);

}  // namespace caustream::optics
