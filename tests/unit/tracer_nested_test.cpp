// The reference tracer where bodies overlap, and at mirrors, against closed forms.
#include <gtest/gtest.h>

#include <algorithm>

#include "scene/builtin_scenes.h"
#include "tests/unit/tracer_worlds.h"

namespace caustream::tracer {
namespace {

constexpr double kLandsM = 1e-9, kShare = 1e-6;

// Bounded sideways only so that the light can be aimed at it; slabs that overlap have their sides apart.
ConvexPlanes slab(double top, double bottom, double halfWidth = 50.0) {
    return {{{0, 1, 0, top}, {0, -1, 0, -bottom}, {1, 0, 0, halfWidth}, {-1, 0, 0, halfWidth}, {0, 0, 1, halfWidth}, {0, 0, -1, halfWidth}}};
}

// The same as triangles, which single precision must place: a little apart from where it is asked to be.
Body bodyOfSlab(double top, double bottom, int glass, double halfWidth = 8.0) { return bodyOf(scenes::convexPolyhedron(slab(top, bottom, halfWidth).planes), glass); }

Glass prior(double index, int priority) {
    Glass glass = glassOf(index);
    glass.priority = priority;
    return glass;
}

// Through layers between y = 3 and the floor: where a beam of `incidence` in `outside` lands, and its share that is never
// reflected.
struct Layer {
    double thick, index;
};
std::pair<double, double> through(const std::vector<Layer>& layers, double incidence) {
    double x = 0.0, share = 1.0;
    const double invariant = layers.front().index * std::sin(incidence);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const double angle = std::asin(invariant / layers[i].index);
        x += layers[i].thick * std::tan(angle);
        if (i > 0) share *= 1.0 - reflectance(std::asin(invariant / layers[i - 1].index), layers[i - 1].index, layers[i].index);
    }
    return {x, share};
}

TEST(TracerNested, ASlabInWaterIsASlabOfTheIndexRatio) {
    for (const double degrees : {0.0, 30.0, 60.0}) {
        const double incidence = radians(degrees);
        const auto [x, share] = through({{1.0, 1.0}, {0.5, 1.52 / 1.33}, {1.5, 1.0}}, incidence);
        World world{.glasses = {prior(1.33, 0), prior(1.52, 1)}, .bodies = {floorAt(0.0f)}, .light = beam({0, 3, 0}, {std::sin(incidence), -std::cos(incidence), 0})};
        world.solids = {{slab(10.0, -10.0, 60.0), 0}, {slab(2.0, 1.5), 1}};   // light and floor are in the water
        EXPECT_NEAR(shareAt(world, {x, 0, 0}, kLandsM), share, kShare) << degrees;
        world.glasses[0].priority = 2;   // water where the slab would be: there is none
        EXPECT_NEAR(shareAt(world, {3.0 * std::tan(incidence), 0, 0}, kLandsM), 1.0, kShare) << degrees;
    }
}

// Two slabs that share the space from y = 1.2 to 1.5.
class Overlap : public testing::TestWithParam<bool> {};

TEST_P(Overlap, BelongsToTheHigherPriority) {
    const double incidence = radians(35.0);
    const auto upperWins = through({{1.0, 1.0}, {0.8, 1.5}, {0.7, 1.8}, {0.5, 1.0}}, incidence);
    const auto lowerWins = through({{1.0, 1.0}, {0.5, 1.5}, {1.0, 1.8}, {0.5, 1.0}}, incidence);
    struct Case {
        int upper, lower;
        bool upperFirst;
        const std::pair<double, double>& expected;
    };
    for (const Case& c : {Case{1, 0, true, upperWins}, Case{1, 0, false, upperWins}, Case{-3, 7, true, lowerWins},
                          Case{0, 0, true, upperWins}, Case{0, 0, false, lowerWins}}) {   // of equal ones the first
        World world{.glasses = {prior(1.5, c.upper), prior(1.8, c.lower)}, .bodies = {floorAt(0.0f)},
                    .light = beam({0, 3, 0}, {std::sin(incidence), -std::cos(incidence), 0})};
        const auto add = [&](bool upper) {
            if (GetParam()) world.bodies.push_back(upper ? bodyOfSlab(2.0, 1.2, 0) : bodyOfSlab(1.5, 0.5, 1, 9.0));
            else world.solids.push_back(upper ? Solid{slab(2.0, 1.2), 0} : Solid{slab(1.5, 0.5, 60.0), 1});
        };
        add(c.upperFirst), add(!c.upperFirst);
        const double lands = GetParam() ? 1e-6 : kLandsM;   // 1.2 is no float
        EXPECT_NEAR(shareAt(world, {c.expected.first, 0, 0}, lands), c.expected.second, kShare) << c.upper << c.lower << c.upperFirst;
    }
}

INSTANTIATE_TEST_SUITE_P(Both, Overlap, testing::Bool(), [](const auto& entry) { return entry.param ? "Triangles" : "Planes"; });

// A glass of water's wall: water that ends inside the glass leaves no sliver between them.
TEST(TracerNested, WaterInAWallTouchesTheGlass) {
    const auto [x, share] = through({{1.0, 1.0}, {0.2, 1.52}, {1.0, 1.33}, {0.2, 1.52}, {0.6, 1.0}}, radians(50.0));
    World world{.glasses = {prior(1.33, 0), prior(1.52, 1)}, .bodies = {floorAt(0.0f)}, .light = beam({0, 3, 0}, {std::sin(radians(50.0)), -std::cos(radians(50.0)), 0})};
    world.solids = {{slab(1.9, 0.7, 60.0), 0}, {slab(2.0, 1.8), 1}, {slab(0.8, 0.6), 1}};
    EXPECT_NEAR(shareAt(world, {x, 0, 0}, kLandsM), share, kShare);
}

// Metal of which .1 absorbs at normal incidence; Schlick's rise is small at 45 degrees.
Glass metal() { return {.absorption = {{380.0, 680.0}, {-std::log(0.9), -std::log(0.9)}}, .mirror = true}; }
double schlick(double incidence) { return 0.9 + 0.1 * std::pow(1.0 - std::cos(incidence), 5.0); }

TEST(TracerMirror, AMirrorAt45DegreesTurnsABeamDown) {
    const double s = std::sqrt(0.5);
    for (const bool triangles : {false, true}) {
        World world{.glasses = {metal()}, .bodies = {floorAt(0.0f)}, .light = beam({-3, 1, 0}, {1, 0, 0})};
        // The face against the beam passes through (0, 1, 0).
        const ConvexPlanes box{{{-s, -s, 0, -s}, {s, s, 0, 1.0}, {s, -s, 0, 0.5}, {-s, s, 0, 2.0}, {0, 0, 1, 1.0}, {0, 0, -1, 1.0}}};
        if (triangles) world.bodies.push_back(bodyOf(scenes::convexPolyhedron(box.planes), 0));
        else world.solids = {{box, 0}};
        Ledger ledger;
        const double share = shareAt(world, {0, 0, 0}, triangles ? 1e-6 : kLandsM, &ledger);
        EXPECT_NEAR(share, schlick(radians(45.0)), kShare);
        EXPECT_NEAR(ledger.mirrors / ledger.onCasters, 1.0 - schlick(radians(45.0)), 1e-7);
        EXPECT_EQ(ledger.firstReflected, 0.0);   // what a mirror throws back is followed whatever the settings say
    }
}

// An open sheet of metal reflects on its other side too.
TEST(TracerMirror, HasTwoSides) {
    World world{.glasses = {metal()}, .bodies = {floorAt(0.0f)}, .light = beam({0, 1, 0}, {0, 1, 0})};
    world.bodies.push_back(bodyOf(scenes::quad({-1, 2, 1}, {1, 2, 1}, {1, 2, -1}, {-1, 2, -1}), 0));   // its normal is up
    EXPECT_NEAR(shareAt(world, {0, 0, 0}, 1e-6), 0.9, kShare);
}

// A gem set into metal: what is under the overlap is metal, whatever the priorities.
TEST(TracerMirror, InGlassIsWhereItIs) {
    World world{.glasses = {prior(1.5, 5), metal()}, .bodies = {floorAt(0.0f)}, .light = beam({0, 1, 0}, {0, 1, 0})};
    world.solids = {{slab(3.0, 1.5), 0}, {slab(4.0, 2.0), 1}};
    EXPECT_NEAR(shareAt(world, {0, 0, 0}, kLandsM), 0.9 * std::pow(1.0 - reflectance(0.0, 1.0, 1.5), 2.0), kShare);
}

// Of the built-in scenes: what the file says arrives.
TEST(TracerNested, ScenesCarryPriorityAndMirrors) {
    const auto water = scene::loadBuiltin("water"), jewel = scene::loadBuiltin("jewel");
    ASSERT_TRUE(water && jewel);
    int differing = 0;
    for (const Glass& glass : worldOf(*water, water->lights[0]).glasses) differing += glass.priority == 1;
    EXPECT_EQ(differing, 1);
    const auto casters = [&](Mirrors mirrors) {
        const World world = worldOf(*jewel, jewel->lights[0], ThinWalls::Receivers, mirrors);
        return std::ranges::count_if(world.bodies, [](const Body& body) { return body.glass >= 0; });
    };
    EXPECT_EQ(casters(Mirrors::Casters), 2);
    EXPECT_EQ(casters(Mirrors::Receivers), 1);
}

// Nested bodies, a mirror and a stone in it: every photon closes.
TEST(TracerNested, EnergyClosesOnTheScenes) {
    for (const char* name : {"water", "jewel", "brilliant", "emerald", "newton", "ball"}) {
        const auto scene = scene::loadBuiltin(name);
        ASSERT_TRUE(scene) << name;
        const Result result = trace(worldOf(*scene, scene->lights[0]), {.wavelengthsNm = {550.0}, .photons = 4000, .firstReflection = true});
        EXPECT_GT(result.hits, 50u) << name;
        EXPECT_LE(result.worstClosure, 1e-12) << name;
        const Ledger& ledger = result.ledgers[0];
        EXPECT_LT(ledger.interfaceLimit + ledger.belowThreshold, 0.05 * ledger.onCasters) << name;
        EXPECT_EQ(ledger.mirrors > 0.0, std::string(name) == "jewel") << name;
    }
}

}  // namespace
}  // namespace caustream::tracer
