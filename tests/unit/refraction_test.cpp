// Snell and Fresnel against closed forms: slab displacement, prism deviation, ball-lens focus, energy, Brewster.
#include <gtest/gtest.h>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "optics/dispersion.h"
#include "optics/fresnel.h"

namespace caustream::optics {
namespace {

constexpr double kPi = std::numbers::pi;

double radians(double degrees) {
    return degrees * kPi / 180.0;
}

// In the x-y plane: pointing `angle` away from -y towards +x.
glm::dvec3 downwards(double angle) {
    return {std::sin(angle), -std::cos(angle), 0.0};
}

// Where a ray meets the plane n . x = d.
glm::dvec3 meet(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& n, double d) {
    return origin + direction * ((d - glm::dot(n, origin)) / glm::dot(n, direction));
}

TEST(Refraction, ObeysSnell) {
    for (double n : {1.0003, 1.33, 1.5, 2.42, 5.6})
        for (double angle = 0.0; angle < 89.5; angle += 5.0) {
            const auto inside = refract(downwards(radians(angle)), {0, 1, 0}, 1.0 / n);
            ASSERT_TRUE(inside);
            EXPECT_NEAR(inside->x * n, std::sin(radians(angle)), 1e-14);
            EXPECT_NEAR(glm::length(*inside), 1.0, 1e-14);
            EXPECT_LT(inside->y, 0.0);
        }
}

TEST(Refraction, StaysInThePlaneOfIncidence) {
    const glm::dvec3 d = glm::normalize(glm::dvec3(0.3, -0.8, 0.5)), n = glm::normalize(glm::dvec3(0.1, 1.0, -0.2));
    EXPECT_NEAR(glm::dot(*refract(d, n, 1.0 / 1.5), glm::cross(d, n)), 0.0, 1e-15);
}

TEST(Refraction, TotalReflectionBeginsAtTheCriticalAngle) {
    const double n = 1.5, critical = std::asin(1.0 / n);
    EXPECT_TRUE(refract(downwards(critical - 1e-6), {0, 1, 0}, n));
    EXPECT_FALSE(refract(downwards(critical + 1e-6), {0, 1, 0}, n));
    EXPECT_EQ(fresnelDielectric(std::cos(critical + 1e-6), n), 1.0);
    EXPECT_LT(fresnelDielectric(std::cos(critical - 1e-6), n), 1.0);
}

TEST(Refraction, NoInterfaceIsNoChange) {
    const glm::dvec3 d = downwards(radians(37.0));
    EXPECT_NEAR(glm::distance(*refract(d, {0, 1, 0}, 1.0), d), 0.0, 1e-15);
    EXPECT_NEAR(fresnelDielectric(0.4, 1.0), 0.0, 1e-15);
}

// Born & Wolf, section 4.8: a slab of thickness t moves a ray sideways by t sin(i - r) / cos r.
TEST(Refraction, SlabDisplacesARay) {
    const double t = 0.7;
    for (double n : {1.2, 1.5, 2.42})
        for (double degrees : {0.0, 10.0, 45.0, 80.0}) {
            const double i = radians(degrees), r = std::asin(std::sin(i) / n);
            const glm::dvec3 d = downwards(i), inside = *refract(d, {0, 1, 0}, 1.0 / n);
            const glm::dvec3 exit = meet({0, 0, 0}, inside, {0, 1, 0}, -t);
            const glm::dvec3 out = *refract(inside, {0, 1, 0}, n);
            EXPECT_NEAR(glm::distance(out, d), 0.0, 1e-14);
            const double sideways = glm::length(exit - glm::dot(exit, d) * d);
            EXPECT_NEAR(sideways, t * std::sin(i - r) / std::cos(r), 1e-14);
        }
}

// Deviation of a ray by a prism of apex angle `apex`, entering at `incidence`.
double prismDeviation(double apex, double incidence, double n) {
    // The apex is up; light comes from the left and passes level when it passes symmetrically.
    const glm::dvec3 entryNormal(-std::cos(apex / 2), std::sin(apex / 2), 0.0);
    const glm::dvec3 exitNormal(std::cos(apex / 2), std::sin(apex / 2), 0.0);
    const glm::dvec3 tangent(std::sin(apex / 2), std::cos(apex / 2), 0.0);
    const glm::dvec3 d = -std::cos(incidence) * entryNormal + std::sin(incidence) * tangent;
    const glm::dvec3 inside = *refract(d, entryNormal, 1.0 / n);
    const glm::dvec3 out = *refract(inside, -exitNormal, n);
    return std::acos(glm::dot(d, out));
}

// n = sin((apex + deviation) / 2) / sin(apex / 2) at minimum deviation (Fraunhofer 1817).
TEST(Refraction, PrismHasItsMinimumDeviation) {
    const double apex = radians(60.0);
    for (double nm : {380.0, 530.0, 680.0}) {
        const double n = refractiveIndex(Cauchy{1.728, 0.01342, 0.0}, nm);
        const double incidence = std::asin(n * std::sin(apex / 2));
        const double least = 2.0 * incidence - apex;
        EXPECT_NEAR(prismDeviation(apex, incidence, n), least, 1e-9);
        EXPECT_GT(prismDeviation(apex, incidence + 0.01, n), least);
        EXPECT_GT(prismDeviation(apex, incidence - 0.01, n), least);
    }
}

// A ball of radius R brings paraxial rays together n R / (2 (n - 1)) behind its centre.
TEST(Refraction, BallLensFocuses) {
    const double R = 0.6, height = 1e-5;
    for (double n : {1.4, 1.5, 1.8}) {
        const glm::dvec3 down(0, -1, 0);
        const glm::dvec3 entry(height, std::sqrt(R * R - height * height), 0.0);
        const glm::dvec3 inside = *refract(down, entry / R, 1.0 / n);
        const glm::dvec3 exit = entry - 2.0 * glm::dot(entry, inside) * inside;
        const glm::dvec3 out = *refract(inside, -exit / R, n);
        const glm::dvec3 focus = meet(exit, out, {1, 0, 0}, 0.0);
        EXPECT_NEAR(-focus.y, n * R / (2.0 * (n - 1.0)), 1e-8);  // third-order aberration: height^2 / R
    }
}

// Transmittance from the amplitude coefficients (Born & Wolf, 1.5.2), so that it is not 1 - R by construction.
double transmittance(double cosI, double eta) {
    const double cosT = std::sqrt(1.0 - eta * eta * (1.0 - cosI * cosI));
    const double ts = 2.0 * eta * cosI / (eta * cosI + cosT), tp = 2.0 * eta * cosI / (cosI + eta * cosT);
    return cosT / (eta * cosI) * 0.5 * (ts * ts + tp * tp);
}

TEST(Fresnel, KeepsEnergy) {
    for (double eta : {1.0 / 5.6, 1.0 / 1.5, 0.9999, 1.3, 1.5})
        for (double cosI = 0.01; cosI <= 1.0; cosI += 0.01)
            if (eta * eta * (1.0 - cosI * cosI) < 1.0) {
                EXPECT_NEAR(fresnelDielectric(cosI, eta) + transmittance(cosI, eta), 1.0, 1e-12);
            }
}

TEST(Fresnel, NormalIncidence) {
    for (double n : {1.0003, 1.5, 2.42}) {
        const double r = (n - 1.0) / (n + 1.0);
        EXPECT_NEAR(fresnelDielectric(1.0, 1.0 / n), r * r, 1e-15);
        EXPECT_NEAR(fresnelDielectric(1.0, n), r * r, 1e-15);
    }
}

// At Brewster's angle one polarisation is not reflected at all, the other by ((n^2 - 1) / (n^2 + 1))^2.
TEST(Fresnel, BrewsterAngle) {
    for (double n : {1.33, 1.5, 2.42}) {
        const double s = (n * n - 1.0) / (n * n + 1.0);
        EXPECT_NEAR(fresnelDielectric(std::cos(std::atan(n)), 1.0 / n), 0.5 * s * s, 1e-14);
    }
}

TEST(Fresnel, GrazingLightIsAllReflected) {
    EXPECT_EQ(fresnelDielectric(0.0, 1.0 / 1.5), 1.0);
    EXPECT_EQ(fresnelDielectric(0.0, 1.5), 1.0);
    EXPECT_EQ(fresnelDielectric(-1e-9, 1.5), 1.0);  // a rounded cosine is still an angle
    EXPECT_TRUE(std::isfinite(fresnelDielectric(0.0, 1.0)));
}

TEST(Fresnel, IsTheSameBothWays) {
    for (double degrees = 0.0; degrees < 89.0; degrees += 3.0) {
        const double i = radians(degrees), t = std::asin(std::sin(i) / 1.7);
        EXPECT_NEAR(fresnelDielectric(std::cos(i), 1.0 / 1.7), fresnelDielectric(std::cos(t), 1.7), 1e-14);
    }
}

}  // namespace
}  // namespace caustream::optics
