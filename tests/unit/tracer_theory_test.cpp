// The reference tracer against closed forms. Beams land where they must within 1e-9 m over metres of way; shares of light
// are float32 values over doubles, so 1e-6.
#include <gtest/gtest.h>

#include <random>

#include "bench/reference/spectrum.h"
#include "optics/colour.h"
#include "tests/unit/tracer_worlds.h"

namespace caustream::tracer {
namespace {

constexpr double kLandsM = 1e-9, kShare = 1e-6;

Solid slab(double top, double bottom, int glass) { return {ConvexPlanes{{{0, 1, 0, top}, {0, -1, 0, -bottom}}}, glass}; }

World slabWorld(double incidence, double index) {
    World world{.glasses = {glassOf(index)}, .bodies = {floorAt(0.0f)}, .light = beam({0, 3, 0}, {std::sin(incidence), -std::cos(incidence), 0})};
    // The slab is infinite: bounded sideways only so that the light can be aimed at it.
    world.solids = {{ConvexPlanes{{{0, 1, 0, 2}, {0, -1, 0, -1.5}, {1, 0, 0, 50}, {-1, 0, 0, 50}, {0, 0, 1, 50}, {0, 0, -1, 50}}}, 0}};
    return world;
}

TEST(TracerTheory, ASlabShiftsABeam) {
    for (const double degrees : {0.0, 20.0, 45.0, 70.0, 85.0}) {
        const double incidence = radians(degrees), index = 1.52, refracted = std::asin(std::sin(incidence) / index);
        const double x = 2.5 * std::tan(incidence) + 0.5 * std::tan(refracted);
        const double passed = std::pow(1.0 - reflectance(incidence, 1.0, index), 2.0);
        EXPECT_NEAR(shareAt(slabWorld(incidence, index), {x, 0, 0}, kLandsM), passed, kShare) << degrees;
    }
}

TEST(TracerTheory, ASlabOfTrianglesShiftsABeamAsWell) {
    const double incidence = radians(45.0), index = 1.52, refracted = std::asin(std::sin(incidence) / index);
    World world = slabWorld(incidence, index);
    world.solids.clear();
    const std::vector<glm::dvec4> planes{{0, 1, 0, 2}, {0, -1, 0, -1.5}, {1, 0, 0, 8}, {-1, 0, 0, 8}, {0, 0, 1, 7}, {0, 0, -1, 6}};
    world.bodies.push_back(bodyOf(scenes::convexPolyhedron(planes), 0));
    const double x = 2.5 * std::tan(incidence) + 0.5 * std::tan(refracted);
    EXPECT_NEAR(shareAt(world, {x, 0, 0}, kLandsM), std::pow(1.0 - reflectance(incidence, 1.0, index), 2.0), kShare);
}

// With every branch followed, a slab lets 1 / (1 + 2R/(1 - R)) through and throws the rest back.
TEST(TracerTheory, ASlabPassesTheSumOfAllItsReflections) {
    for (const double degrees : {0.0, 45.0, 80.0}) {
        const double R = reflectance(radians(degrees), 1.0, 1.52);
        Ledger ledger;
        shareAt(slabWorld(radians(degrees), 1.52), {0, 0, 0}, 1.0, &ledger, 1e-15);
        EXPECT_NEAR(ledger.landed / ledger.onCasters, (1.0 - R) / (1.0 + R), 1e-9) << degrees;
        EXPECT_NEAR(ledger.firstReflected / ledger.onCasters, R, 1e-12) << degrees;
        EXPECT_NEAR((ledger.firstReflected + ledger.escaped) / ledger.onCasters, 2.0 * R / (1.0 + R), 1e-9) << degrees;
    }
}

TEST(TracerTheory, TwoSlabsAndAbsorptionMultiply) {
    World world = slabWorld(0.0, 1.5);
    world.glasses = {glassOf(1.5, 0.3), glassOf(1.8)};
    world.solids = {slab(2.0, 1.5, 0), slab(1.0, 0.25, 1)};
    for (Solid& solid : world.solids) {
        auto& planes = std::get<ConvexPlanes>(solid.shape).planes;
        for (const glm::dvec3& side : {glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1)}) planes.emplace_back(side, 5.0);
    }
    const double passed = std::pow(1.0 - reflectance(0, 1.0, 1.5), 2.0) * std::pow(1.0 - reflectance(0, 1.0, 1.8), 2.0) * std::exp(-0.3 * 0.5);
    EXPECT_NEAR(shareAt(world, {0, 0, 0}, kLandsM), passed, kShare);
}

TEST(TracerTheory, APrismTurnsLeastAtItsMinimumDeviation) {
    const double apex = radians(60.0), index = 1.62, half = 0.5 * apex, incidence = std::asin(index * std::sin(half));
    World world{.glasses = {glassOf(index)}, .bodies = {floorAt(0.0f)}};
    // The apex up at y = 2; the beam meets the left face at y = 1.8, runs level inside and leaves at the mirrored point.
    const glm::dvec3 left(-std::cos(half), std::sin(half), 0), right(std::cos(half), std::sin(half), 0);
    world.solids = {{ConvexPlanes{{{left, 2.0 * std::sin(half)}, {right, 2.0 * std::sin(half)}, {0, -1, 0, -1.5}, {0, 0, 1, 1}, {0, 0, -1, 1}}}, 0}};
    const double x = 0.2 * std::tan(half), turn = incidence - half;
    const glm::dvec3 entry(-x, 1.8, 0), up(std::cos(turn), std::sin(turn), 0);
    world.light = beam(entry - 1.5 * up, up);
    const double passed = std::pow(1.0 - reflectance(incidence, 1.0, index), 2.0);
    EXPECT_NEAR(shareAt(world, {x + 1.8 / std::tan(turn), 0, 0}, kLandsM), passed, kShare);
}

// A ray at height h crosses the axis at r sin(i) / sin(2 (i - t)) from the centre: n r / (2 (n - 1)) near the axis.
TEST(TracerTheory, ABallLensFocuses) {
    const double index = 1.5, radius = 0.5;
    for (const double h : {1e-4, 0.1, 0.3, 0.49}) {
        const double i = std::asin(h / radius), t = std::asin(h / radius / index), focus = h / std::sin(2.0 * (i - t));
        if (h < 1e-3) {
            EXPECT_NEAR(focus, index * radius / (2.0 * (index - 1.0)), 1e-7);
        }
        World world{.glasses = {glassOf(index)}, .bodies = {floorAt(0.0f)}, .light = beam({h, focus + 2.0, 0}, {0, -1, 0})};
        world.solids = {{Sphere{{0, focus, 0}, radius}, 0}};
        EXPECT_NEAR(shareAt(world, {0, 0, 0}, kLandsM), std::pow(1.0 - reflectance(i, 1.0, index), 2.0), kShare) << h;
    }
}

TEST(TracerTheory, LightInsideABallGoesStraightOutFromItsCentre) {
    World world{.glasses = {glassOf(1.5, 0.2)}, .bodies = {floorAt(0.0f)}, .light = beam({0, 1, 0}, {0.6, -0.8, 0})};
    world.solids = {{Sphere{{0, 1, 0}, 0.5}, 0}};
    EXPECT_NEAR(shareAt(world, {0.75, 0, 0}, kLandsM), (1.0 - reflectance(0, 1.5, 1.0)) * std::exp(-0.1), kShare);
}

// A ball of the index of what is around it is not there: the map is 1 in its shadow, the floor has cos / r^2.
class NoInterface : public testing::TestWithParam<bool> {};

TEST_P(NoInterface, GivesDirectLightBack) {
    World world{.glasses = {glassOf(1.33)}, .bodies = {floorAt(0.0f)}, .outsideIndex = 1.33};
    if (GetParam()) world.bodies.push_back(bodyOf(scenes::icosphere(3, {0, 1, 0}, 0.5), 0));
    else world.solids = {{Sphere{{0, 1, 0}, 0.5}, 0}};
    world.light = spot({0, 3, 0}, {0, -1, 0}, radians(20));
    Settings settings{.wavelengthsNm = {550.0}, .continuousSamples = 2, .photons = 200'000};
    settings.windows = {{{-0.25, 0, -0.25}, {0.5, 0, 0}, {0, 0, 0.5}, 4, 4}};
    // Looks down -Y with tangents of .125 and .1; x = X, y = Z of the world.
    glm::dmat4 toClip(0.0);
    toClip[0][0] = 8.0, toClip[2][1] = 10.0, toClip[1][3] = -1.0, toClip[3][3] = 3.0, toClip[3][2] = 0.01;
    settings.maps = {{toClip, 4}};
    const Result result = trace(world, settings);
    EXPECT_EQ(result.ledgers[0].firstReflected, 0.0);
    EXPECT_EQ(result.ledgers[0].absorbed, 0.0);
    EXPECT_NEAR(result.ledgers[0].landed, result.ledgers[0].onCasters, 1e-15);
    EXPECT_EQ(result.hidden[0], 0.0);
    // 200,000 photons over about 40 cells of this size: .4% on the worst of them.
    const auto blackXyz = optics::intervalXyz(380.0, 680.0);
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
            const double x = (i - 1.5) * 0.125, z = (j - 1.5) * 0.125, r2 = 9.0 + x * x + z * z;
            EXPECT_NEAR(result.windows[0].bands.at(0, j, i), 3.0 / (r2 * std::sqrt(r2)), 0.01 * 3.0 / 27.0);
            EXPECT_NEAR(result.maps[0].bands.at(0, j, i), 1.0, 0.01);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(result.maps[0].xyz.at(c, j, i) / blackXyz[c], 1.0, 0.02);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Both, NoInterface, testing::Bool(), [](const auto& entry) { return entry.param ? "Triangles" : "Sphere"; });

TEST(TracerTheory, ADirectionalLightHasAConcentrationOfOneToo) {
    World world{.glasses = {glassOf(1.0)}, .bodies = {floorAt(0.0f)}};
    world.solids = {{Sphere{{0, 1, 0}, 0.5}, 0}};
    world.light = {.type = scene::LightType::Directional, .direction = {0, -1, 0}};
    Settings settings{.wavelengthsNm = {550.0}, .photons = 100'000};
    glm::dmat4 toClip(0.0);
    toClip[0][0] = 4.0, toClip[2][1] = 4.0, toClip[3][3] = 1.0;
    settings.maps = {{toClip, 4}};
    const Result result = trace(world, settings);
    for (const float value : result.maps[0].bands.values) EXPECT_NEAR(value, 1.0, 0.01);   // 8,000 photons a texel, evenly
}

// The beam goes around a shelf that hides its landing from the light.
TEST(TracerTheory, WhatTheLightDoesNotSeeIsBookedApart) {
    World world = slabWorld(radians(60.0), 1.9);
    const double x = 2.5 * std::tan(radians(60.0)) + 0.5 * std::tan(std::asin(std::sin(radians(60.0)) / 1.9));
    const glm::dvec3 middle = 0.5 * (glm::dvec3(0, 3, 0) + glm::dvec3(x, 0, 0));   // at y = 1.5 the slab ends
    const float at = static_cast<float>(middle.x + 0.4 * (x - middle.x)), y = 0.9f;
    Settings settings{.wavelengthsNm = {550.0}, .photons = 8, .minWeight = 0.5};
    glm::dmat4 toClip(0.0);   // a wide view straight down from the light
    toClip[0][0] = 0.2, toClip[2][1] = 0.2, toClip[1][3] = -1.0, toClip[3][3] = 3.0;
    settings.maps = {{toClip, 8}};
    const Result open = trace(world, settings);
    EXPECT_EQ(open.hidden[0], 0.0);
    world.bodies.push_back(bodyOf(scenes::quad({at - 0.1f, y, 0.2f}, {at + 0.1f, y, 0.2f}, {at + 0.1f, y, -0.2f}, {at - 0.1f, y, -0.2f}), -1));
    const Result shaded = trace(world, settings);
    EXPECT_NEAR(shaded.hidden[0] / shaded.ledgers[0].landed, 1.0, 1e-12);
    for (const float value : shaded.maps[0].bands.values) EXPECT_EQ(value, 0.0f);
}

// Light, glass and receivers anywhere, touching, overlapping or around the light.
TEST(TracerTheory, EveryPhotonsEnergyIsAccountedFor) {
    int lit = 0;
    for (unsigned seed = 1; seed <= 24; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        const auto place = [&](double y) { return glm::dvec3(2.0 * unit(random) - 1.0, y + unit(random), 2.0 * unit(random) - 1.0); };
        World world{.bodies = {floorAt(0.0f)}, .outsideIndex = 1.0 + 0.4 * unit(random)};
        for (int i = 0; i < 4; ++i) {
            world.glasses.push_back({optics::Cauchy{1.2 + unit(random), 0.2 * unit(random), 0.0}, {{380.0, 680.0}, {unit(random), 3.0 * unit(random)}}});
            scenes::Mesh mesh = scenes::icosphere(i, place(0.5), 0.2 + 0.5 * unit(random));
            if (i % 2 == 1) scenes::smoothNormals(mesh);
            if (i == 3) mesh.indices.resize(mesh.indices.size() * 3 / 4);   // open
            world.bodies.push_back(bodyOf(mesh, i));
        }
        if (seed % 2 == 0) {   // not all as entered: a mirror beside them, and what overlaps by priority
            for (int i = 0; i < 4; ++i) world.glasses[static_cast<std::size_t>(i)].priority = static_cast<int>(random() % 3) - 1;
            world.glasses.push_back({.absorption = {{380.0, 680.0}, {0.1, 1.0}}, .mirror = true});
            world.bodies.push_back(bodyOf(scenes::icosphere(2, {1.5, 0.3 + unit(random), 0.0}, 0.4), 4));
        }
        world.solids = {{Sphere{place(0.5), 0.4}, 0}, {ConvexPlanes{{{1, 0, 0, 1.5}, {-1, 0, 0, -1.1}, {0, 1, 0, 1.5}, {0, -1, 0, -0.2}, {0, 0, 1, 0.4}, {0, 0, -1, 0.4}}}, 1}};
        world.light = spot(place(seed % 3 == 0 ? 0.8 : 2.5), {0.1, -1, 0.1}, radians(5.0 + 60.0 * unit(random)));
        world.light.innerConeRad *= unit(random);
        world.light.type = seed % 4 == 0 ? scene::LightType::Point : seed % 4 == 1 ? scene::LightType::Directional : scene::LightType::Spot;
        world.light.cookie = {2, 2, {1.0, 0.5, 0.25, 0.0}};
        const Result result = trace(world, {.wavelengthsNm = {400.0, 650.0}, .continuousSamples = 2, .photons = 2000, .minWeight = 1e-3, .firstReflection = seed % 2 == 0});
        if (result.hits == 0) continue;   // a narrow cone that misses
        ++lit;
        EXPECT_LE(result.worstClosure, 1e-12) << seed;
        for (const Ledger& ledger : {result.ledgers[0], result.ledgers[1], result.continuous}) {
            EXPECT_GT(ledger.landed, 0.0) << seed;
            EXPECT_NEAR(ledger.landed + ledger.absorbed + ledger.mirrors + ledger.firstReflected + ledger.belowThreshold + ledger.interfaceLimit + ledger.escaped,
                        ledger.onCasters, 1e-12 * ledger.onCasters) << seed;
        }
    }
    EXPECT_GE(lit, 20);
}

TEST(TracerSpectrum, EverySpectrumsDirectLightHasYOne) {
    for (const optics::Spectrum& spectrum : {optics::Spectrum(optics::EqualEnergy{}), optics::Spectrum(optics::DaylightD65{}),
                                             optics::Spectrum(optics::Blackbody{3000.0}), optics::Spectrum(optics::Lines{{450.0, 550.0, 640.0}})}) {
        for (const Observer observer : {Observer::Cie1931, Observer::Wyman2013}) {
            const SpectrumSampler sampler(spectrum, observer, 600);
            glm::dvec3 sum(0.0);
            double share = 0.0;
            for (std::size_t i = 0; i < sampler.count(); ++i) sum += sampler.at(i, 0.5).xyz, share += sampler.at(i, 0.5).share;
            EXPECT_NEAR(sum.y, 1.0, 1e-5);   // midpoints of half a nm against those of 1/16
            EXPECT_NEAR(share, 1.0, 1e-12);
        }
    }
}

// Wyman, Sloan & Shirley 2013 give their fit within a few hundredths of the observer's peak.
TEST(TracerSpectrum, TheFitIsNearTheTable) {
    for (double nm = 380.0; nm <= 680.0; nm += 5.0) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(wymanXyz(nm)[c], optics::cieXyz(nm)[c], 0.05) << nm;
    }
}

}  // namespace
}  // namespace caustream::tracer
