// What the bench measures with: colour differences, the front, resampling, the journal, names of configurations.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>

#include "bench/accuracy/colour_difference.h"
#include "bench/accuracy/configuration.h"
#include "bench/accuracy/fingerprint.h"
#include "bench/accuracy/journal.h"
#include "bench/accuracy/pareto.h"
#include "bench/accuracy/plot.h"
#include "bench/accuracy/subject.h"
#include "bench/accuracy/window.h"
#include "bench/reference/tracer.h"
#include "bench/statistics.h"
#include "render/view.h"

namespace caustream::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Pair {
    glm::dvec3 a, b;
    double difference;
};

// Sharma, Wu & Dalal 2005, table 1: the pairs that tell apart implementations that are almost right.
TEST(Ciede2000, PublishedPairs) {
    const Pair pairs[] = {
        {{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
        {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
        {{50, 2.8361, -74.0200}, {50, 0, -82.7485}, 3.4412},
        {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
        {{50, -1.1848, -84.8006}, {50, 0, -82.7485}, 1.0000},
        {{50, -0.9009, -85.5211}, {50, 0, -82.7485}, 1.0000},
        {{50, 0, 0}, {50, -1, 2}, 2.3669},
        {{50, -1, 2}, {50, 0, 0}, 2.3669},
        {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0009}, 7.1792},
        {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0010}, 7.1792},
        {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0011}, 7.2195},
        {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0012}, 7.2195},
        {{50, -0.0010, 2.4900}, {50, 0.0009, -2.4900}, 4.8045},
        {{50, -0.0010, 2.4900}, {50, 0.0010, -2.4900}, 4.8045},
        {{50, -0.0010, 2.4900}, {50, 0.0011, -2.4900}, 4.7461},
        {{50, 2.5, 0}, {50, 0, -2.5}, 4.3065},
        {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
        {{50, 2.5, 0}, {61, -5, 29}, 22.8977},
        {{50, 2.5, 0}, {56, -27, -3}, 31.9030},
        {{50, 2.5, 0}, {58, 24, 15}, 19.4535},
        {{50, 2.5, 0}, {50, 3.1736, 0.5854}, 1.0000},
        {{50, 2.5, 0}, {50, 3.2972, 0}, 1.0000},
        {{50, 2.5, 0}, {50, 1.8634, 0.5757}, 1.0000},
        {{50, 2.5, 0}, {50, 3.2592, 0.3350}, 1.0000},
        {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
        {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
        {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
        {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
        {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
        {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
        {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
        {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
        {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
        {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
    };
    for (const Pair& pair : pairs) {
        EXPECT_NEAR(ciede2000(pair.a, pair.b), pair.difference, 5e-5);   // printed to four places
        EXPECT_NEAR(ciede2000(pair.b, pair.a), pair.difference, 5e-5);
    }
}

TEST(Ciede2000, LabOfWhiteBlackAndGrey) {
    EXPECT_NEAR(labOfSrgb(255, 255, 255).x, 100.0, 1e-9);
    EXPECT_NEAR(labOfSrgb(255, 255, 255).y, 0.0, 1e-9);
    EXPECT_NEAR(labOfSrgb(0, 0, 0).x, 0.0, 1e-9);
    EXPECT_NEAR(labOfSrgb(119, 119, 119).x, 50.0, 0.1);   // sRGB's middle grey
}

TEST(Ciede2000, Pictures) {
    std::vector<std::uint8_t> a(300, 119), b = a;
    EXPECT_EQ(pictureDifference(a, b).mean, 0.0);
    b[0] = b[1] = b[2] = 129;   // one pixel of 100
    const double one = ciede2000(labOfSrgb(119, 119, 119), labOfSrgb(129, 129, 129));
    EXPECT_NEAR(pictureDifference(a, b).mean, one / 100.0, 1e-12);
    EXPECT_LT(pictureDifference(a, b).p99, one);
}

TEST(Statistics, Quantiles) {
    EXPECT_EQ(median({}), 0.0);
    EXPECT_EQ(median({3, 1, 2}), 2.0);
    EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
    EXPECT_EQ(quantile({0, 10}, 0.25), 2.5);
}

TEST(Pareto, FrontAndBest) {
    const std::vector<Cost> costs = {{20, 0.2}, {10, 0.5}, {30, 0.3}, {40, 0.1}, {10, 0.6}, {40, 0.1}};
    EXPECT_THAT(paretoFront(costs), ElementsAre(1, 0, 3));   // 2 is slower and worse than 0, 4 and 5 add nothing
    EXPECT_EQ(bestWithin(costs, 5), std::nullopt);
    EXPECT_EQ(bestWithin(costs, 10), 1u);
    EXPECT_EQ(bestWithin(costs, 39), 0u);
    EXPECT_EQ(bestWithin(costs), 3u);
    EXPECT_TRUE(paretoFront({}).empty());
}

TEST(Configuration, NamesAreReadBack) {
    const auto thesis = parseConfiguration("mode=thesis,wavelengths=21,grid=512,map=256,gap_fill=on,levels=6");
    ASSERT_TRUE(thesis);
    EXPECT_EQ(thesis->transport.mode, render::Mode::Thesis);
    EXPECT_EQ(thesis->name(), "thesis 21 grid 512 map 256 levels 6 gap fill");
    EXPECT_EQ(parseConfiguration("wavelengths=continuous,steps=2")->name(), "refined continuous grid 256 map 512 steps 2");
    EXPECT_THAT(parseConfiguration("wavelengths=65").error(), HasSubstr("\"wavelengths=65\" is not one of mode="));
    EXPECT_THAT(parseConfiguration("grid").error(), HasSubstr("\"grid\""));
}

TEST(Configuration, DefaultsAreAllDifferent) {
    for (const bool quick : {true, false}) {
        std::vector<std::string> names;
        for (const Configuration& configuration : defaultConfigurations(quick)) names.push_back(configuration.name());
        std::ranges::sort(names);
        EXPECT_TRUE(std::ranges::adjacent_find(names) == names.end());
        EXPECT_GE(names.size(), quick ? 5u : 20u);
    }
}

// A light 2 m above the floor and a map of 64^2 texels whose view spans 1 m of it.
struct Bench {
    scene::Light light;
    render::View view;
    Bench() {
        light.position = {0, 2, 0};
        view.worldToView = render::lookAlong(light.position, {0, -1, 0}, {0, 0, -1});
        view.halfExtent = glm::vec2(0.25f);   // tangent
    }
    // Concentration from a function of the floor's x and z.
    template <class Value>
    render::Frame frame(Value value) const {
        constexpr int kSize = 64;
        render::Frame frame;
        frame.width = frame.height = kSize;
        frame.sample = render::Sample::F32;
        frame.lightMatrix = view.worldToClip();
        const Window texels = Window::ofView(light, glm::dmat4(frame.lightMatrix), kSize);
        std::vector<float> map;
        for (int j = 0; j < kSize; ++j) {
            for (int i = 0; i < kSize; ++i) {
                const glm::dvec3 towards = texels.at(i + 0.5, j + 0.5) - glm::dvec3(light.position);
                const glm::dvec3 floor = glm::dvec3(light.position) - towards * (2.0 / towards.y);
                for (int band = 0; band < 3; ++band) map.push_back(static_cast<float>(value(floor.x, floor.z)));
            }
        }
        frame.pixels.resize(map.size() * sizeof(float));
        std::memcpy(frame.pixels.data(), map.data(), frame.pixels.size());
        return frame;
    }
};

TEST(Window, FluxOfAPlainMapIsTheSolidAngle) {
    const Bench bench;
    const render::Frame even = bench.frame([](double, double) { return 1.0; });
    const Window floor = Window::onPlane(bench.light, {-0.4, 0, -0.4}, {0.8, 0, 0}, {0, 0, 0.8}, 32);
    const std::vector<float> values = resample(even, floor);
    double flux = 0.0;
    for (std::size_t i = 0; i < 32 * 32; ++i) flux += values[i] * 0.025 * 0.025;
    // Of a pyramid with half tangents of 0.2: 4 asin(sin a sin b).
    const double sine = 0.2 / std::hypot(1.0, 0.2);
    EXPECT_NEAR(flux, 4.0 * std::asin(sine * sine), 1e-4 * flux);
    // A view's cells weigh 1 on average, the middle most.
    const Window directions = Window::ofView(bench.light, glm::dmat4(even.lightMatrix), 32);
    double mean = 0.0;
    for (const float value : resample(even, directions)) mean += value / (3.0 * 32 * 32);
    EXPECT_NEAR(mean, 1.0, 1e-5);
    EXPECT_GT(directions.weights()[32 * 16 + 16], directions.weights()[0]);
}

TEST(Window, DifferencesOfMaps) {
    const Bench bench;
    const auto spot = [](double x0) { return [x0](double x, double z) { return std::hypot(x - x0, z) < 0.1 ? 1.0 : 0.0; }; };
    const Window floor = Window::onPlane(bench.light, {-0.4, 0, -0.4}, {0.8, 0, 0}, {0, 0, 0.8}, 40);
    const std::vector<float> here = resample(bench.frame(spot(0.0)), floor), there = resample(bench.frame(spot(0.06)), floor);
    const tracer::Difference same = tracer::difference(here.data(), here.data(), 40, 40);
    EXPECT_EQ(same.relativeL1, 0.0);
    EXPECT_EQ(same.worst, 0.0);
    EXPECT_EQ(same.fluxRatio, 1.0);
    // Three cells to the right: as much light, most of it in place.
    const tracer::Difference moved = tracer::difference(there.data(), here.data(), 40, 40);
    EXPECT_NEAR(moved.centroidCells, 3.0, 0.15);
    EXPECT_NEAR(moved.fluxRatio, 1.0, 0.02);
    EXPECT_GT(moved.relativeL1, 0.3);
    const std::vector<float> twice = resample(bench.frame([&](double x, double z) { return 2.0 * spot(0.0)(x, z); }), floor);
    EXPECT_NEAR(tracer::difference(twice.data(), here.data(), 40, 40).fluxRatio, 2.0, 1e-6);
    EXPECT_NEAR(tracer::difference(twice.data(), here.data(), 40, 40).relativeL1, 1.0, 1e-6);
}

// The same light in a view twice as wide and turned: the cells see the same.
TEST(Window, MapsOfOtherViewsAreComparedInTheSamePlace) {
    Bench bench, wide;
    wide.view.worldToView = render::lookAlong(wide.light.position, glm::normalize(glm::vec3(0.1f, -1, 0.05f)), {1, 0, 1});
    wide.view.halfExtent = glm::vec2(0.5f);
    const auto smooth = [](double x, double z) { return std::exp(-20.0 * (x * x + z * z)) * (1.0 + x); };
    const Window window = Window::ofView(bench.light, glm::dmat4(bench.view.worldToClip()), 32);
    const std::vector<float> a = resample(bench.frame(smooth), window), b = resample(wide.frame(smooth), window);
    const tracer::Difference d = tracer::difference(b.data(), a.data(), 32, 32);
    EXPECT_LT(d.relativeL1, 0.05);   // texels of twice the size
    EXPECT_NEAR(d.fluxRatio, 1.0, 0.005);
    EXPECT_LT(d.centroidCells, 0.1);
}

TEST(Window, ColoursThereAndBack) {
    std::vector<float> values = {1, 0.2f, 1, 0.5f, 1, 0.1f};   // white and another
    const std::vector<float> before = values;
    rgbToXyz(values, optics::EqualEnergy{});
    EXPECT_NEAR(values[2], 1.0, 1e-5);   // Y of white
    xyzToRgb(values, optics::EqualEnergy{});
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(values[i], before[i], 1e-5);
}

TEST(Journal, GoesOnWhereItEndedAndKeepsThingsApart) {
    const std::string path = testing::TempDir() + "caustream_journal_test/results.jsonl";
    const nlohmann::json key = {{"scene", "gem"}, {"build", "a"}}, other = {{"scene", "gem"}, {"build", "b"}};
    {
        Journal journal(path, true);
        EXPECT_TRUE(journal.of(key).empty());
        journal.add(key, 1);
        journal.add(key, 2);
    }
    std::ofstream(path, std::ios::app) << R"({"key":{"build":"a","scene":"gem"},"resu)";   // cut short
    {
        Journal journal(path);
        EXPECT_THAT(journal.of(key), ElementsAre(1, 2));
        EXPECT_TRUE(journal.of(other).empty());
        journal.add(other, 3);
    }
    EXPECT_THAT(Journal(path).of(key), ElementsAre(1, 2));
    EXPECT_THAT(Journal(path).of(other), ElementsAre(3));
    EXPECT_TRUE(Journal(path, true).of(key).empty());
    std::filesystem::remove_all(std::filesystem::path(path).parent_path());
}

TEST(Fingerprint, TellsInputsApart) {
    EXPECT_EQ(fingerprint(""), "cbf29ce484222325");
    EXPECT_EQ(fingerprint("a"), "af63dc4c8601ec8c");   // published by Fowler, Noll & Vo
    EXPECT_NE(fingerprint("ab"), fingerprint("ba"));
    EXPECT_EQ(buildFingerprint(), buildFingerprint());
}

TEST(Subject, ShareOfTheLightsViewAndItsOwnName) {
    const Subject sphere = loadSubject("sphere");
    const Subject wide = withShare(sphere, 0.025), narrow = withShare(sphere, 0.33);
    EXPECT_GT(wide.light().outerConeDeg, narrow.light().outerConeDeg);
    EXPECT_NE(wide.fingerprint, sphere.fingerprint);
    EXPECT_NE(wide.fingerprint, narrow.fingerprint);
    EXPECT_EQ(narrow.name, "sphere at 33%");
    EXPECT_NE(withMovedLight(sphere.scene, 1).lights.front().position, withMovedLight(sphere.scene, 2).lights.front().position);
    EXPECT_TRUE(loadSubject("reference:prism").plane);
    EXPECT_ANY_THROW(loadSubject("no such scene"));
}

TEST(Plot, NamesTheFrontAndEscapesText) {
    Plot plot{.title = "a < b", .points = {{{10, 0.5}, "one", "fast"}, {{100, 0.1}, "two", "fine"}, {{200, 0.2}, "two", "useless"}}};
    const std::string drawn = svg(plot);
    EXPECT_THAT(drawn, HasSubstr("a &lt; b"));
    EXPECT_THAT(drawn, HasSubstr(">fast<"));
    EXPECT_THAT(drawn, HasSubstr(">fine<"));
    EXPECT_THAT(drawn, testing::Not(HasSubstr(">useless<")));
    EXPECT_THAT(drawn, testing::Not(HasSubstr("\"nan")));
}

}  // namespace
}  // namespace caustream::bench
