// Exact photons, from their definition: any partition of the same ones gives the same sums of 64 bits, all their light is
// booked, and glass of the outside's index is not there.
#include <numeric>

#include "bench/stability/scene_parts.h"
#include "render/light_views.h"
#include "render/passes/map_adapt.h"
#include "render/passes/photon_paths.h"
#include "render/passes/receiver_depth.h"
#include "tests/gpu/camera_fixture.h"
#include "tests/gpu/light_buffers.h"

namespace caustream::tests {
namespace {

constexpr int kMapSize = 64;
constexpr std::uint32_t kPhotons = 3000;
constexpr int kSpectra = 2;

struct Traced {
    std::vector<GLuint> map, outerMap, landings, outerLandings;
    std::array<double, layout::kLedgerRows> ledger{};
};

double wide(const std::vector<GLuint>& words, std::size_t first) { return 4294967296.0 * words[first + 1] + words[first]; }

double luminance(const std::vector<GLuint>& map) {
    double sum = 0.0;
    for (std::size_t texel = 0; texel < map.size(); texel += layout::kWideWords) {
        sum += wide(map, texel + layout::kWideEvenY) + wide(map, texel + layout::kWideEvenY + 2);
    }
    return sum;
}

class PhotonPathsTest : public CameraPass {
   protected:
    // The scene's first caster, in runs of photons that end at `ends`.
    Traced trace(const scene::Scene& scene, const std::vector<std::uint32_t>& ends, double fixedPerFlux = 1 << 20) {
        const render::ExactSurfaces surfaces(scene);
        const render::GpuScene gpu(scene.geometry);
        const scene::Light& light = scene.lights[0];
        const scene::Object& caster = scene.geometry->objects[surfaces.casters()[0].object];
        const render::View emission = render::emissionView(scene, light, caster).value(), cone = render::shadowView(scene, light);
        gl::Texture receivers;
        const auto mirror = [&](const scene::Object& object) { return scene.materials[static_cast<std::size_t>(object.material)].mirror; };
        render::ReceiverDepth(shaders_).run({gpu, scene.materials, cone, kMapSize, false, 1.0, mirror}, receivers);
        const optics::WavelengthSet set = optics::continuousSpectrum(4);
        render::SpectralTable table;
        const render::SpectralEntries entries = render::spectralEntries(set);
        table.fill(scene, surfaces.casters(), entries);

        constexpr std::size_t kTexels = kMapSize * kMapSize;
        const gl::Buffer map = makeZeroed(kTexels * layout::kWideWords, "map"), outerMap = makeZeroed(kTexels * layout::kWideWords, "outer map");
        const gl::Buffer landings = makeZeroed(kTexels, "landings"), outerLandings = makeZeroed(kTexels, "outer landings");
        Traced out;
        std::uint32_t first = 0;
        for (const std::uint32_t end : ends) {
            const gl::Buffer ledger = makeLedger();
            const double perFlux = 2147483648.0 / (end - first);
            render::PhotonPaths(shaders_).run({.surfaces = surfaces, .table = table, .emission = emission, .mapView = cone, .outerView = cone,
                                               .receivers = receivers, .outerReceivers = receivers, .light = light, .emitter = 0,
                                               .firstPhoton = first, .photons = end - first, .spectra = kSpectra,
                                               .entries = static_cast<int>(entries.nm.size()), .continuous = true, .exactReceivers = true,
                                               .fixedPerFlux = fixedPerFlux, .ledgerPerFlux = perFlux},
                                              {map, outerMap, landings, outerLandings, ledger});
            glMemoryBarrier(GL_ALL_BARRIER_BITS);
            const auto rows = ledgerRows(ledger);
            for (std::size_t i = 0; i < rows.size(); ++i) out.ledger[i] += rows[i] / perFlux;
            first = end;
        }
        out.map = readWords(map), out.outerMap = readWords(outerMap), out.landings = readWords(landings), out.outerLandings = readWords(outerLandings);
        return out;
    }
};

TEST_F(PhotonPathsTest, AnyPartitionGivesTheSameSums) {
    for (const scene::Scene& scene : {stability::prismScene({optics::Cauchy{1.5, 0.02}}), stability::sphereScene({optics::Cauchy{1.5, 0.02}})}) {
        const Traced whole = trace(scene, {kPhotons});
        EXPECT_GT(luminance(whole.map), 0.0);
        for (const std::vector<std::uint32_t>& ends : {std::vector<std::uint32_t>{1, 2, kPhotons}, {1000, 2000, kPhotons}, {1537, kPhotons}}) {
            const Traced parts = trace(scene, ends);
            EXPECT_EQ(parts.map, whole.map);
            EXPECT_EQ(parts.outerMap, whole.outerMap);
            EXPECT_EQ(parts.landings, whole.landings);
        }
    }
}

// A unit so small that low words run over all the time: the high words hold what does not fit.
TEST_F(PhotonPathsTest, SumsRunOverIntoTheirHighWords) {
    const scene::Scene scene = stability::prismScene({optics::ConstantIndex{1.5}});
    const double unit = 1 << 20, small = std::ldexp(1.0, 30);
    const Traced coarse = trace(scene, {kPhotons}, unit), fine = trace(scene, {kPhotons}, small);
    EXPECT_GT(luminance(fine.map), 4294967296.0);
    EXPECT_NEAR(luminance(fine.map) / small, luminance(coarse.map) / unit, 1e-5 * luminance(coarse.map) / unit);
}

TEST_F(PhotonPathsTest, AllLightIsBooked) {
    for (const scene::Scene& scene : {stability::prismScene({optics::Cauchy{1.5, 0.02}}), stability::sphereScene({optics::Cauchy{1.5, 0.02}})}) {
        const Traced traced = trace(scene, {kPhotons});
        const double deposited = (luminance(traced.map) + luminance(traced.outerMap)) / (1 << 20);
        double booked = deposited;
        for (const int row : {layout::kLedgerAbsorbed, layout::kLedgerReflected, layout::kLedgerRejected, layout::kLedgerLeftMap,
                              layout::kLedgerNoReceiver, layout::kLedgerCut}) booked += traced.ledger[static_cast<std::size_t>(row)];
        EXPECT_GT(deposited, 0.0);
        EXPECT_NEAR(booked / traced.ledger[layout::kLedgerOnCasters], 1.0, 1e-4);
    }
}

TEST_F(PhotonPathsTest, GlassOfTheOutsidesIndexIsNotThere) {
    const scene::Scene scene = stability::sphereScene({optics::ConstantIndex{1.0}});
    const Traced traced = trace(scene, {kPhotons});
    const double onCasters = traced.ledger[layout::kLedgerOnCasters];
    EXPECT_NEAR((luminance(traced.map) + luminance(traced.outerMap)) / (1 << 20) / onCasters, 1.0, 1e-4);
    EXPECT_NEAR(traced.ledger[layout::kLedgerReflected] / onCasters, 0.0, 1e-6);
}

// A mirror throws light up at the underside of a thin board, whose upper side is what the light sees there.
TEST_F(PhotonPathsTest, LightOnTheBackOfABoardIsNotOnItsFront) {
    SyntheticScene parts;
    scene::Material mirror = stability::white();
    mirror.mirror = true;
    const int board = parts.material(stability::white());
    parts.addQuad(parts.material(mirror), {-0.2f, 0, 0.2f}, {0.4f, 0, 0}, {0, 0, -0.4f});
    parts.addBox(board, {0.3f, 1.5f, -1.0f}, {2.0f, 1.502f, 1.0f});
    const Traced traced = trace(stability::finish(parts, stability::spotAbove({-2, 3, 0}, {0, 0, 0}, 40.0f)), {kPhotons});
    const double onCasters = traced.ledger[layout::kLedgerOnCasters];
    ASSERT_GT(onCasters, 0.0);
    EXPECT_EQ(luminance(traced.map), 0.0);
    EXPECT_NEAR(traced.ledger[layout::kLedgerLeftMap] / onCasters, 1.0, 0.05);   // what the mirror keeps is absorbed
}

// A standing mirror throws light back at a floor that the light itself sees at a few degrees: a texel's floor is then far
// nearer at one of its sides than at the other, and yet the same floor.
TEST_F(PhotonPathsTest, LightOnASlantedFloorIsInTheMap) {
    SyntheticScene parts;
    scene::Material mirror = stability::white();
    mirror.mirror = true;
    parts.addQuad(parts.material(mirror), {0.5f, 0, -0.3f}, {0, 0, 0.6f}, {0, 0.2f, 0});
    parts.addQuad(parts.material(stability::white()), {-1.5f, 0, 2}, {4, 0, 0}, {0, 0, -4});
    const Traced traced = trace(stability::finish(parts, stability::spotAbove({-2, 0.6f, 0}, {0.5f, 0.1f, 0}, 40.0f)), {kPhotons});
    const double onCasters = traced.ledger[layout::kLedgerOnCasters];
    ASSERT_GT(onCasters, 0.0);
    EXPECT_NEAR(traced.ledger[layout::kLedgerLeftMap] / onCasters, 0.0, 1e-4);
    EXPECT_GT(luminance(traced.map) / (1 << 20) / onCasters, 0.9);
}

}  // namespace
}  // namespace caustream::tests
