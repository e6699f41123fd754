// Tables of the CIE, every 5 or 10 nm over the band. Only colour.cpp, spectrum.cpp and tests need them.
#pragma once
#include <array>

namespace caustream::optics {

inline constexpr double kCieStepNm = 5.0, kD65StepNm = 10.0;
extern const std::array<std::array<double, 3>, 61> kCie1931;  // x, y, z at 380, 385, ... 680 nm
extern const std::array<double, 31> kD65;                     // 380, 390, ... 680 nm; 100 at 560 nm

}  // namespace caustream::optics
