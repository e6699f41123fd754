// The choice for a budget or a target error, with costs and errors that are given.
#include "render/choose_transport.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace caustream::render {
namespace {

using testing::HasSubstr;

// A frame of a sphere-like scene: 12 ns a texel, `photonNs` a photon, 20 ms that do not scale.
FrameStats frameOf(const Transport& transport, std::uint32_t photons, double photonNs) {
    FrameStats stats;
    stats.photons = photons;
    const double texels = static_cast<double>(transport.mapSize) * transport.mapSize;
    stats.stages = {{"caster_layers", 3.0}, {"receiver_depth", 2.0}, {"photon_trace", 1e-6 * photonNs * photons},
                    {"map_resolve", 12e-6 * texels}, {"camera_receivers", 15.0}};
    for (const StageTime& stage : stats.stages) stats.renderMs += stage.ms;
    return stats;
}

Transport transportOf(int grid, int size, int wavelengths) {
    Transport transport;
    transport.photonGrid = grid, transport.mapSize = size, transport.wavelengths = wavelengths;
    return transport;
}

Transport within(double budgetMs) {
    Transport wanted;
    wanted.budgetMs = budgetMs;
    return wanted;
}
Transport asGoodAs(double targetError) {
    Transport wanted;
    wanted.targetError = targetError;
    return wanted;
}

const int kSceneOne = 0;
constexpr ErrorEstimate kSphere{.sampling = 0.03, .spectral = 0.01, .total = 0.032, .resolution = 0.03};

Calibration calibrated(double photonNs = 600.0) {
    Calibration calibration;
    const Transport ran = transportOf(256, 512, 7);
    calibration.learnCost(ran, frameOf(ran, 50000, 1e6), true);   // the first compiles
    calibration.learnCost(ran, frameOf(ran, 50000, photonNs), true);
    calibration.learnError(&kSceneOne, ran, kSphere, 50000);
    return calibration;
}

std::vector<Configuration> frontOf(const Calibration& calibration, bool dispersive = true) {
    return paretoFront(calibration.configurations(&kSceneOne, Transport{}, dispersive, {}));
}

TEST(ParetoFront, HasNoDominatedEntryAndLosesNoOther) {
    const std::vector<Configuration> all = calibrated().configurations(&kSceneOne, Transport{}, true, {});
    const std::vector<Configuration> front = paretoFront(all);
    ASSERT_GT(front.size(), 3u);
    for (std::size_t i = 1; i < front.size(); ++i) {
        EXPECT_GT(front[i].ms, front[i - 1].ms);
        EXPECT_LT(front[i].error, front[i - 1].error);
    }
    for (const Configuration& one : all) {
        EXPECT_TRUE(std::any_of(front.begin(), front.end(), [&](const Configuration& best) { return best.ms <= one.ms && best.error <= one.error; }));
    }
}

TEST(Choice, MoreTimeNeverErrsMoreAndABetterTargetNeverCostsLess) {
    const std::vector<Configuration> front = frontOf(calibrated());
    double error = 2.0, ms = 0.0;
    for (double budget = 1.0; budget < 3000.0; budget *= 1.1) {
        const Choice choice = choose(front, within(budget));
        EXPECT_LE(choice.configuration.error, error) << budget;
        if (choice.met) {
            EXPECT_LE(choice.configuration.ms, budget);
        }
        error = choice.configuration.error;
    }
    for (double target = 1.0; target > 1e-4; target /= 1.1) {
        const Choice choice = choose(front, asGoodAs(target));
        EXPECT_GE(choice.configuration.ms, ms) << target;
        EXPECT_LT(choice.configuration.ms, 2000.0);   // no target is worth more
        if (choice.met) {
            EXPECT_LE(choice.configuration.error, target);
        }
        ms = choice.configuration.ms;
    }
}

TEST(Choice, SaysWhatAndWhy) {
    const std::vector<Configuration> front = frontOf(calibrated());
    const Choice choice = choose(front, within(60.0));
    EXPECT_TRUE(choice.met);
    EXPECT_THAT(choice.sentence, HasSubstr("photon grid " + std::to_string(choice.configuration.photonGrid)));
    EXPECT_THAT(choice.sentence, HasSubstr("map " + std::to_string(choice.configuration.mapSize)));
    EXPECT_THAT(choice.sentence, HasSubstr(", the best that 60 ms allow"));
    EXPECT_THAT(choose(front, asGoodAs(0.05)).sentence, HasSubstr("the fastest that reaches 5%"));
}

TEST(Choice, TheImpossibleGetsTheNearestAndIsTold) {
    const std::vector<Configuration> front = frontOf(calibrated());
    const Choice fast = choose(front, within(1.0)), good = choose(front, asGoodAs(1e-4));
    EXPECT_FALSE(fast.met);
    EXPECT_TRUE(fast.configuration.sameAs(front.front()));
    EXPECT_THAT(fast.sentence, HasSubstr("nothing keeps within 1 ms"));
    EXPECT_FALSE(good.met);
    EXPECT_LT(good.configuration.error, fast.configuration.error);
    EXPECT_THAT(good.sentence, HasSubstr("nothing reaches 0.01%"));
}

TEST(Choice, KeepsWhatIsNearlyAsGood) {
    const std::vector<Configuration> front = {{64, 128, 1, 4, 20, 0.20}, {128, 256, 7, 4, 40, 0.104}, {180, 256, 7, 4, 42, 0.10}, {256, 512, 7, 4, 80, 0.05}};
    EXPECT_TRUE(choose(front, within(45), front[1]).configuration.sameAs(front[1]));   // the best is hardly better
    EXPECT_TRUE(choose(front, within(39), front[1]).configuration.sameAs(front[1]));   // hardly over the budget
    EXPECT_TRUE(choose(front, within(30), front[1]).configuration.sameAs(front[0]));   // far over it
    EXPECT_TRUE(choose(front, within(90), front[1]).configuration.sameAs(front[3]));   // far behind the best
    EXPECT_TRUE(choose(front, asGoodAs(0.1), front[1]).configuration.sameAs(front[1]));
}

TEST(Calibration, AFasterMachineIsGivenMore) {
    const std::vector<Configuration> slow = frontOf(calibrated(6000.0)), fast = frontOf(calibrated(6.0));
    EXPECT_LT(choose(fast, within(45)).configuration.error, choose(slow, within(45)).configuration.error);
    EXPECT_GT(choose(fast, within(45)).configuration.photonGrid, choose(slow, within(45)).configuration.photonGrid);
}

TEST(Calibration, ExpectsWhatItMeasured) {
    for (const Configuration& c : calibrated().configurations(&kSceneOne, Transport{}, true, {})) {
        if (!c.sameAs({256, 512, 7, 4})) continue;
        EXPECT_NEAR(c.ms, frameOf(transportOf(256, 512, 7), 50000, 600.0).renderMs, 1e-9);
        EXPECT_NEAR(c.error, std::hypot(kSphere.sampling, kSphere.spectral, kSphere.resolution), 0.002);
    }
}

TEST(Calibration, AContinuousSpectrumTellsNothingOfExactWavelengths) {
    Calibration calibration = calibrated();
    const auto errorOf = [&](int wavelengths) {
        for (const Configuration& c : calibration.configurations(&kSceneOne, Transport{}, true, {})) {
            if (c.sameAs({256, 512, wavelengths, 8})) return c.error;
        }
        return 0.0;
    };
    const double one = errorOf(1), seven = errorOf(7);
    EXPECT_GT(one, seven);
    calibration.learnError(&kSceneOne, transportOf(256, 512, kContinuous), {.sampling = 0.03, .spectral = 1e-5, .total = 0.03, .resolution = 0.03}, 50000);
    EXPECT_DOUBLE_EQ(errorOf(1), one);
    EXPECT_LT(errorOf(kContinuous), seven);
}

TEST(Calibration, OneSlowFrameDoesNotRuleAKindOfSpectrumOut) {
    Calibration calibration = calibrated();
    const auto costOf = [&](int wavelengths) {
        for (const Configuration& c : calibration.configurations(&kSceneOne, Transport{}, true, {})) {
            if (c.sameAs({256, 512, wavelengths, 4})) return c.ms;
        }
        return 0.0;
    };
    const double before = costOf(kContinuous);
    const Transport ran = transportOf(256, 512, kContinuous);
    for (int i = 0; i < 2; ++i) calibration.learnCost(ran, frameOf(ran, 50000, 1e6), true);
    EXPECT_LT(costOf(kContinuous), 2.0 * before);
    for (int i = 0; i < 3; ++i) calibration.learnCost(ran, frameOf(ran, 50000, 1e6), true);
    EXPECT_GT(costOf(kContinuous), 1000.0);   // it is so slow indeed
}

TEST(Calibration, OneSlowFrameChangesNothing) {
    Calibration calibration = calibrated();
    const Transport ran = transportOf(256, 512, 7);
    for (int i = 0; i < 4; ++i) calibration.learnCost(ran, frameOf(ran, 50000, 600.0), true);
    const double before = frontOf(calibration).front().ms;
    calibration.learnCost(ran, frameOf(ran, 50000, 60000.0), true);
    EXPECT_EQ(frontOf(calibration).front().ms, before);
}

TEST(Calibration, OffersOneWavelengthWhereNoGlassDispersesAndWhatIsKept) {
    for (const Configuration& c : calibrated().configurations(&kSceneOne, Transport{}, false, {})) EXPECT_EQ(c.wavelengths, 1);
    for (const Configuration& c : calibrated().configurations(&kSceneOne, transportOf(0, 512, 13), true, {.wavelengths = true})) EXPECT_EQ(c.wavelengths, 13);
    for (const Configuration& c : calibrated().configurations(&kSceneOne, transportOf(0, 300, 13), true, {.mapSize = true})) EXPECT_EQ(c.mapSize, 300);
}

}  // namespace
}  // namespace caustream::render
