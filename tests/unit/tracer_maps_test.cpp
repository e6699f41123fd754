// The reference tracer against the reference maps, its cache, and its repeatability.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "scene/gltf_loader.h"
#include "tests/reference/reference.h"
#include "tests/unit/tracer_worlds.h"

namespace caustream::tracer {
namespace {

namespace fs = std::filesystem;

constexpr int kBlock = 8;   // cells of the maps joined to one, a side: few photons cannot tell 65,536 cells apart

std::vector<float> coarse(const float* map, int cells) {
    const int size = cells / kBlock;
    std::vector<float> out(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    for (int j = 0; j < size * kBlock; ++j) {
        for (int i = 0; i < size * kBlock; ++i) out[static_cast<std::size_t>(j / kBlock * size + i / kBlock)] += map[j * cells + i] / (kBlock * kBlock);
    }
    return out;
}

Window windowOf(const reference::Reference& reference) {
    const auto& w = reference.window;
    return {{w.x0, 0, w.z0}, {w.width, 0, 0}, {0, 0, w.width}, w.cells, w.cells};
}

// At 2^16 photons in blocks of 8 x 8 cells. The limits are twice what is measured, which is sampling: at 2^23 photons
// and single cells the differences are the maps' own errors (docs/accuracy.md).
struct Case {
    const char* scene;
    double relativeL1, flux, centroidCells;
};

class ReferenceMaps : public testing::TestWithParam<Case> {};

TEST_P(ReferenceMaps, AgreeWithTheTracer) {
    const Case& limits = GetParam();
    const reference::Reference reference = reference::load(limits.scene);
    const std::string folder = std::string(CAUSTREAM_TEST_DATA) + "/../reference/";
    const World world = worldOfJson(folder + limits.scene + ".json");
    // The maps end paths at 16 interfaces; the gem sends .3% of its violet through more.
    Settings settings{.wavelengthsNm = {380.0, 530.0, 680.0}, .photons = 1u << 16, .maxInterfaces = 16, .windows = {windowOf(reference)}};
    const Result result = trace(world, settings);
    EXPECT_LE(result.worstClosure, 1e-12);
    for (int band = 0; band < 3; ++band) {
        const int cells = reference.window.cells, area = cells * cells;
        const auto& bands = reference.json.at("files").at(std::string(limits.scene) + "_mono7.npy").at("per_wavelength").at(static_cast<std::size_t>(3 * band));
        const Ledger& ledger = result.ledgers[static_cast<std::size_t>(band)];
        EXPECT_NEAR(ledger.onCasters / bands.at("flux_incident_on_object_W").get<double>(), 1.0, 1e-3);
        EXPECT_NEAR(ledger.firstReflected / bands.at("flux_front_reflected_W").get<double>(), 1.0, 5e-3);
        const Difference d = difference(coarse(&result.windows[0].bands.values[static_cast<std::size_t>(band * area)], cells).data(),
                                        coarse(&reference.mono7.values[static_cast<std::size_t>(3 * band * area)], cells).data(), cells / kBlock, cells / kBlock);
        std::printf("%s, band %d: relative L1 %.4f, flux ratio %.5f, centroid %.4f blocks\n", limits.scene, 3 * band, d.relativeL1, d.fluxRatio, d.centroidCells);
        EXPECT_LE(d.relativeL1, limits.relativeL1);
        EXPECT_NEAR(d.fluxRatio, 1.0, limits.flux);
        EXPECT_LE(d.centroidCells, limits.centroidCells);
    }
}

INSTANTIATE_TEST_SUITE_P(All, ReferenceMaps, testing::Values(Case{"sphere", 0.02, 5e-4, 0.005}, Case{"prism", 0.004, 5e-4, 0.002}, Case{"gem", 0.03, 0.003, 0.005}),
                         [](const auto& entry) { return std::string(entry.param.scene); });

TEST(TracerMaps, AgreesWithThePrismsContinuousSpectrum) {
    const reference::Reference reference = reference::load("prism");
    const World world = worldOfJson(std::string(CAUSTREAM_TEST_DATA) + "/../reference/prism.json");
    const Result result = trace(world, {.continuousSamples = 4, .observer = Observer::Wyman2013, .photons = 1u << 16, .windows = {windowOf(reference)}});
    const int cells = reference.window.cells;
    for (int c = 0; c < 3; ++c) {
        const auto first = static_cast<std::size_t>(c * cells * cells);
        const Difference d = difference(coarse(&result.windows[0].xyz.values[first], cells).data(), coarse(&reference.xyz->values[first], cells).data(),
                                        cells / kBlock, cells / kBlock);
        std::printf("prism, %c: relative L1 %.4f, flux ratio %.5f, centroid %.4f blocks\n", "XYZ"[c], d.relativeL1, d.fluxRatio, d.centroidCells);
        EXPECT_LE(d.relativeL1, 0.007);
        EXPECT_NEAR(d.fluxRatio, 1.0, 1e-4);
        EXPECT_LE(d.centroidCells, 0.004);
    }
}

// A loaded GLB and the JSON it was made from are the same scene, but for single precision.
TEST(TracerMaps, AMeshGivesWhatItsPlanesGive) {
    const reference::Reference reference = reference::load("prism");
    const std::vector<std::uint8_t> glb = reference::makeGlb(reference);
    const auto scene = scene::loadGlb(std::as_bytes(std::span(glb)), "prism");
    ASSERT_TRUE(scene) << scene.error().message;
    const Settings settings{.wavelengthsNm = {530.0}, .photons = 1u << 14, .windows = {windowOf(reference)}};
    const Result planes = trace(worldOfJson(std::string(CAUSTREAM_TEST_DATA) + "/../reference/prism.json"), settings);
    const Result mesh = trace(worldOf(*scene, scene->lights[0]), settings);
    EXPECT_NEAR(mesh.extent / planes.extent, 1.0, 1e-6);
    // Photons within 1e-7 m of a cell's edge fall on its other side.
    const Difference d = difference(mesh.windows[0].bands.values.data(), planes.windows[0].bands.values.data(), 256, 256);
    EXPECT_LE(d.relativeL1, 0.01);
    EXPECT_NEAR(d.fluxRatio, 1.0, 1e-5);
}

World smallWorld() {
    World world{.glasses = {glassOf(1.5, 0.1)}, .bodies = {floorAt(0.0f)}, .light = spot({0.5, 3, 0}, {-0.5, -2, 0}, radians(30))};
    world.bodies.push_back(bodyOf(scenes::icosphere(2, {0, 1, 0}, 0.5), 0));
    return world;
}

Settings smallSettings() {
    return {.wavelengthsNm = {450.0, 600.0}, .continuousSamples = 2, .photons = 5'000, .windows = {{{-1, 0, -1}, {2, 0, 0}, {0, 0, 2}, 16, 16}}};
}

void expectSame(const Result& a, const Result& b) {
    EXPECT_EQ(a.windows[0].bands.values, b.windows[0].bands.values);
    EXPECT_EQ(a.windows[0].xyz.values, b.windows[0].xyz.values);
    EXPECT_EQ(a.windows[0].bands.relativeL1, b.windows[0].bands.relativeL1);
    EXPECT_EQ(a.ledgers[1].landed, b.ledgers[1].landed);
    EXPECT_EQ(a.continuous.absorbed, b.continuous.absorbed);
    EXPECT_EQ(a.hits, b.hits);
}

TEST(TracerMaps, OneThreadAndTwoGiveTheSameBits) {
    Settings settings = smallSettings();
    const Result two = trace(smallWorld(), settings);
    settings.threads = 1;
    expectSame(trace(smallWorld(), settings), two);
}

TEST(TracerMaps, TheErrorEstimateIsOfTheErrorsSize) {
    Settings settings{.wavelengthsNm = {600.0}, .photons = 10'000, .windows = smallSettings().windows};
    const Result few = trace(smallWorld(), settings);
    settings.photons *= 16;
    const Result many = trace(smallWorld(), settings);
    const Difference d = difference(few.windows[0].bands.values.data(), many.windows[0].bands.values.data(), 16, 16);
    EXPECT_GT(few.windows[0].bands.relativeL1[0], d.relativeL1 / 2.0);
    EXPECT_LT(few.windows[0].bands.relativeL1[0], d.relativeL1 * 2.0);
}

TEST(TracerMaps, ProgressEndsAtOneAndMayStopTheTrace) {
    double last = 0.0;
    trace(smallWorld(), smallSettings(), [&](double done) {
        EXPECT_GE(done, last);
        last = done;
    });
    EXPECT_EQ(last, 1.0);
    EXPECT_THROW(trace(smallWorld(), smallSettings(), [](double) { throw std::runtime_error("enough"); }), std::runtime_error);
    EXPECT_THROW(trace(smallWorld(), {.photons = 0}), std::invalid_argument);
}

class TracerCache : public testing::Test {
 protected:
    void TearDown() override { fs::remove_all(folder_); }
    std::vector<fs::path> files() const {
        std::vector<fs::path> found;
        for (const auto& entry : fs::directory_iterator(folder_)) found.push_back(entry.path());
        return found;
    }
    const fs::path folder_ = fs::path(testing::TempDir()) / ("caustream_trace_" + std::to_string(::getpid()));
};

TEST_F(TracerCache, GivesBackWhatWasTraced) {
    const Result traced = traceCached(folder_, smallWorld(), smallSettings());
    EXPECT_FALSE(traced.cached);
    const Result cached = traceCached(folder_, smallWorld(), smallSettings());
    EXPECT_TRUE(cached.cached);
    expectSame(cached, traced);
    EXPECT_EQ(files().size(), 1u);
}

TEST_F(TracerCache, ADamagedFileIsTracedAnew) {
    const Result traced = traceCached(folder_, smallWorld(), smallSettings());
    std::fstream file(files().front(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(200);
    file.put('x').put('y');
    file.close();
    const Result again = traceCached(folder_, smallWorld(), smallSettings());
    EXPECT_FALSE(again.cached);
    expectSame(again, traced);
    fs::resize_file(files().front(), 100);
    EXPECT_FALSE(traceCached(folder_, smallWorld(), smallSettings()).cached);
    EXPECT_TRUE(traceCached(folder_, smallWorld(), smallSettings()).cached);
}

TEST_F(TracerCache, AnythingElseIsAnotherResult) {
    traceCached(folder_, smallWorld(), smallSettings());
    World moved = smallWorld();
    moved.bodies[1].positions[0].x += 1e-7;
    EXPECT_FALSE(traceCached(folder_, moved, smallSettings()).cached);
    World coloured = smallWorld();
    coloured.light.spectrum = optics::DaylightD65{};
    EXPECT_FALSE(traceCached(folder_, coloured, smallSettings()).cached);
    Settings more = smallSettings();
    more.maxInterfaces = 31;
    EXPECT_FALSE(traceCached(folder_, smallWorld(), more).cached);
    EXPECT_EQ(files().size(), 4u);
}

}  // namespace
}  // namespace caustream::tracer
