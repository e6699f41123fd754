// Numbers that a seed decides alone: the standard library's distributions differ from one library to another.
#pragma once
#include <cmath>
#include <cstdint>
#include <glm/gtc/constants.hpp>
#include <glm/vec3.hpp>

namespace caustream::stability {

class Random {   // SplitMix64 (Steele, Lea and Flood 2014)
   public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    double uniform(double low = 0.0, double high = 1.0) { return low + (high - low) * 0x1p-53 * static_cast<double>(next() >> 11); }
    double logarithmic(double low, double high) { return low * std::pow(high / low, uniform()); }
    int upTo(int most) { return static_cast<int>(next() % static_cast<std::uint64_t>(most + 1)); }   // 0..most
    bool oneIn(int n) { return upTo(n - 1) == 0; }
    glm::vec3 direction() {
        const double z = uniform(-1.0, 1.0), r = std::sqrt(1.0 - z * z), turn = uniform(0.0, glm::two_pi<double>());
        return {r * std::cos(turn), z, r * std::sin(turn)};
    }

   private:
    std::uint64_t next() {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15ull;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return z ^ (z >> 31);
    }
    std::uint64_t state_;
};

}  // namespace caustream::stability
