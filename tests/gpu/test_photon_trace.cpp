// photon_trace against closed forms: where slabs and prisms send light, and how much of it arrives.
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>

#include "optics/fresnel.h"
#include "render/passes/caster_layers.h"
#include "render/passes/map_resolve.h"
#include "render/passes/photon_list.h"
#include "render/passes/photon_trace.h"
#include "render/passes/receiver_depth.h"
#include "tests/gpu/camera_fixture.h"
#include "tests/gpu/light_buffers.h"

namespace caustream::tests {
namespace {

using render::View;

// A beam along -Z from z = 3 and what it meets; the floor of the tests is the plane z = -2, across the beam.
class PhotonTraceTest : public CameraPass {
   protected:
    static constexpr double kFixedPerFlux = 1 << 28, kLedgerPerFlux = 1 << 28;

    struct Setup {
        View emission = parallelView({0, 0, 3}, {0, 0, 0}, 0.25f), back = parallelView({0, 0, 3}, {0, 0, 0}, 1.5f);
        View map = parallelView({0, 0, 3}, {0, 0, 0}, 2.0f), outer = parallelView({0, 0, 3}, {0, 0, 0}, 8.0f);
        int photons = 16, mapSize = kSize, levels = 1;
        std::vector<double> indices = {1.5};      // of the glass, a band each
        double absorptionPerM = 0.0;
        bool xyz = false;                         // sums (1, 1, 1) of each index instead of bands
        bool countResiduals = false;
    };
    struct Result {
        std::vector<GLuint> map;                  // [texel][band]
        std::array<GLuint, layout::kLedgerRows> ledger;
        std::vector<glm::vec4> concentration;     // xyz: of the inner map
        std::vector<GLuint> residuals;            // [histogram][bin]
    };

    Result trace(const SyntheticScene& scene, const Setup& setup) {
        const render::GpuScene gpu(scene.geometry());
        scene::Light light = spotAt({0, 0, 3}, {0, 0, -1}, 1.0f);
        light.type = setup.emission.perspective ? scene::LightType::Point : scene::LightType::Directional;

        render::CasterLayers layers(shaders_);
        gl::Texture front, back, receivers, outerReceivers;
        const scene::Object& caster = gpu.geometry().objects[0];
        layers.run({gpu, caster, setup.emission, setup.photons, setup.photons, nullptr}, render::CasterLayers::Side::Front, front);
        layers.run({gpu, caster, setup.back, 256, 256, nullptr}, render::CasterLayers::Side::Back, back);
        render::ReceiverDepth depth(shaders_);
        depth.run({gpu, scene.materials, setup.map, setup.mapSize}, receivers);
        depth.run({gpu, scene.materials, setup.outer, kSize}, outerReceivers);
        gl::Buffer list;
        const gl::Buffer ledger = makeLedger();
        render::PhotonList(shaders_).run({front, setup.emission, light}, list, ledger);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);   // list -> trace

        std::vector<render::TracedWavelength> wavelengths;
        const double share = 1.0 / double(setup.indices.size());
        for (const double n : setup.indices) wavelengths.push_back({587.56, 1.0 / n, setup.absorptionPerM, share, glm::dvec3(share)});
        std::size_t texels = kSize * kSize;
        for (int level = 0; level < setup.levels; ++level) texels += std::size_t(setup.mapSize >> level) * std::size_t(setup.mapSize >> level);
        const int bands = setup.xyz ? 0 : int(setup.indices.size());
        const gl::Buffer residuals = makeZeroed(layout::kResidualHistograms * layout::kResidualBins, "residuals");
        const gl::Buffer map = makeZeroed(texels * std::size_t(setup.xyz ? layout::kMapWords : bands), "map");
        render::PhotonTrace(shaders_).run({.front = front, .back = back, .receivers = receivers, .outerReceivers = outerReceivers,
                                           .emission = setup.emission, .backView = setup.back, .mapView = setup.map,
                                           .outerView = setup.outer, .list = list, .light = light, .wavelengths = wavelengths,
                                           .bands = bands, .fixedPerFlux = kFixedPerFlux, .ledgerPerFlux = kLedgerPerFlux,
                                           .levels = setup.levels, .residuals = setup.countResiduals ? &residuals : nullptr},
                                          {map, ledger});
        glMemoryBarrier(GL_ALL_BARRIER_BITS);   // map -> resolve, read-back
        Result result{readWords(map), {}, {}, readWords(residuals)};
        if (setup.xyz) {
            gl::Texture concentration;
            render::MapResolve(shaders_).run({.map = &map, .view = setup.map, .receivers = receivers, .size = setup.mapSize, .levels = setup.levels,
                                              .firstTexel = 0, .xyzToRgb = glm::mat3(1.0f), .fluxPerFixed = 1.0 / kFixedPerFlux,
                                              .ledgerPerFixed = kLedgerPerFlux / kFixedPerFlux, .judged = false},
                                             concentration, ledger);
            glMemoryBarrier(GL_ALL_BARRIER_BITS);   // ledger -> read-back
            result.concentration = readTexture(concentration);
        }
        result.ledger = ledgerRows(ledger);
        return result;
    }

    // Flux and mean place (m across the beam) of a band in the first level of the inner map.
    struct Spot {
        double flux = 0;
        glm::dvec2 place{0.0};
    };
    static Spot spot(const Result& result, const Setup& setup, std::size_t band = 0) {
        Spot spot;
        for (int i = 0; i < setup.mapSize * setup.mapSize; ++i) {
            const double flux = result.map[std::size_t(i) * setup.indices.size() + band] / kFixedPerFlux;
            const glm::dvec2 middle(i % setup.mapSize + 0.5, i / setup.mapSize + 0.5);
            spot.place += flux * (2.0 * middle / double(setup.mapSize) - 1.0) * glm::dvec2(setup.map.halfExtent);
            spot.flux += flux;
        }
        spot.place /= spot.flux;
        return spot;
    }

    // Box of half sizes `half` around the origin, turned about Y, then the floor.
    static SyntheticScene boxAndFloor(const glm::vec3& half, float turnDeg) {
        SyntheticScene scene;
        scene.addBox(scene.material(glass()), -half, half);
        const glm::mat3 turn(glm::rotate(glm::mat4(1.0f), glm::radians(turnDeg), glm::vec3(0, 1, 0)));
        for (scene::Vertex& vertex : scene.edit().vertices) vertex.position = turn * vertex.position, vertex.normal = turn * vertex.normal;
        addFloor(scene);
        return scene;
    }
    static void addFloor(SyntheticScene& scene) {
        scene.addQuad(scene.material(matte(glm::vec3(1.0f))), {-20, -20, -2}, {40, 0, 0}, {0, 40, 0});
    }
};

TEST_F(PhotonTraceTest, SlabShiftsTheBeamSideways) {
    constexpr double kThickness = 0.4;
    for (const double angleDeg : {0.0, 20.0, 40.0, 60.0}) {
        const SyntheticScene scene = boxAndFloor({1.2, 1.2, kThickness / 2}, float(angleDeg));
        Setup setup;
        setup.emission.halfExtent = glm::vec2(0.1f);
        setup.indices = {1.3, 1.5, 2.4};
        const Result result = trace(scene, setup);
        for (std::size_t band = 0; band < setup.indices.size(); ++band) {
            // d sin(i) (1 - cos i / (n cos t)), away from the side the slab's face turns to
            const double i = glm::radians(angleDeg), t = std::asin(std::sin(i) / setup.indices[band]);
            const double shift = kThickness * std::sin(i) * (1.0 - std::cos(i) / (setup.indices[band] * std::cos(t)));
            const Spot found = spot(result, setup, band);
            EXPECT_NEAR(std::abs(found.place.x), shift, 2e-4) << angleDeg << " deg";   // layers and Newton in float
            EXPECT_NEAR(found.place.y, 0.0, 2e-4);
            // Two equal Fresnel losses
            const double kept = 1.0 - optics::fresnelDielectric(std::cos(i), 1.0 / setup.indices[band]);
            EXPECT_NEAR(found.flux, 0.2 * 0.2 * kept * kept, 2e-5 * 0.04) << angleDeg << " deg";
        }
    }
}

TEST_F(PhotonTraceTest, ResidualsAreCountedForEachSearchAndVanishOnFlatFaces) {
    const SyntheticScene scene = boxAndFloor({1.2, 1.2, 0.2}, 20.0f);
    Setup setup;
    setup.indices = {1.52, 1.51, 1.5};
    const Result unexamined = trace(scene, setup);
    EXPECT_EQ(std::accumulate(unexamined.residuals.begin(), unexamined.residuals.end(), 0u), 0u);
    setup.countResiduals = true;
    const Result result = trace(scene, setup);
    EXPECT_EQ(result.map, unexamined.map);
    const auto total = [&](int histogram, int bins) {
        const auto first = result.residuals.begin() + histogram * layout::kResidualBins;
        return std::accumulate(first, first + bins, 0u);
    };
    // Each photon searches its exit and its receiver once, at the longest wavelength, and follows them at the others. A
    // step on a plane is exact: what it leaves is rounding, below a hundredth of the tolerance (1e-5 m).
    const GLuint photons = result.ledger[layout::kLedgerPhotons];
    EXPECT_EQ(total(layout::kResidualExit, layout::kResidualBins), photons);
    EXPECT_EQ(total(layout::kResidualExit, 5), photons);
    EXPECT_EQ(total(layout::kResidualReceiver, layout::kResidualBins), photons);
    EXPECT_EQ(total(layout::kResidualReceiver, 5), photons);
    EXPECT_EQ(total(layout::kResidualExitFollowed, layout::kResidualBins), 2 * photons);
}

TEST_F(PhotonTraceTest, PrismTurnsTheBeamByItsDeviation) {
    // Apex 60 degrees on +X, the faces' middles at z = +-h; the beam enters the middle of the upper face.
    constexpr double kApex = glm::pi<double>() / 3.0;
    const double index = 1.5, least = std::asin(index * std::sin(kApex / 2.0));
    const glm::dvec3 upper(std::sin(kApex / 2), 0, std::cos(kApex / 2)), lower(upper.x, 0, -upper.z);
    SyntheticScene scene;
    const glm::vec3 a(1, 0, 0), b(-1, 0, 2 * std::tan(kApex / 2)), c(-1, 0, -b.z), y(0, 1, 0);
    scene.addFlat(scene.material(glass()), {a - y, b + y, b - y, a - y, a + y, b + y, a - y, c - y, c + y, a - y, c + y, a + y,
                                            b - y, b + y, c + y, b - y, c + y, c - y, a - y, b - y, c - y, a + y, c + y, b + y});
    // Incidence `least` on the upper face: turn the prism so that the beam along -Z does so.
    const double turn = least - std::acos(upper.z);
    const glm::mat3 matrix(glm::rotate(glm::mat4(1.0f), float(turn), glm::vec3(0, 1, 0)));
    const glm::vec3 middle = matrix * (0.5f * (a + b));
    for (scene::Vertex& vertex : scene.edit().vertices) {
        vertex.position = matrix * vertex.position - glm::vec3(middle.x, 0, 0);
        vertex.normal = matrix * vertex.normal;
    }
    addFloor(scene);

    Setup setup;
    setup.emission.halfExtent = glm::vec2(0.05f);
    setup.back.halfExtent = glm::vec2(2.5f);
    setup.map.halfExtent = glm::vec2(5.0f);
    setup.indices = {1.45, 1.5, 1.55};
    const Result result = trace(scene, setup);
    for (std::size_t band = 0; band < setup.indices.size(); ++band) {
        const double n = setup.indices[band];
        const glm::dvec3 in = glm::dmat3(matrix) * upper, out = glm::dmat3(matrix) * lower, down(0, 0, -1);
        const auto inside = optics::refract(down, in, 1.0 / n);
        const glm::dvec3 entry(0, 0, middle.z), corner = glm::dmat3(matrix) * glm::dvec3(a) - glm::dvec3(middle.x, 0, 0);
        const glm::dvec3 exit = entry + *inside * (glm::dot(corner - entry, out) / glm::dot(*inside, out));
        const auto outside = optics::refract(*inside, -out, n);
        ASSERT_TRUE(outside);
        const double deviation = std::acos(glm::dot(down, *outside));
        // The closed form of the deviation, least where the way is symmetric
        const double t = kApex - std::asin(std::sin(least) / n);
        EXPECT_NEAR(deviation, least + std::asin(n * std::sin(t)) - kApex, 1e-7);
        if (n == index) {
            EXPECT_NEAR(deviation, 2.0 * least - kApex, 1e-7);   // the prism is turned in float
        }
        const glm::dvec3 landing = exit + *outside * ((-2.0 - exit.z) / outside->z);
        EXPECT_NEAR(spot(result, setup, band).place.x, landing.x, 1e-3) << n;   // float layers, lengthened by 1 / cos^2
    }
}

TEST_F(PhotonTraceTest, NormalIncidenceKeepsItsSolidAngle) {
    Setup setup;
    setup.emission = setup.back = setup.map = lookingAt({0, 0, 3}, {0, 0, 0}, 2.0f);
    setup.back.halfExtent *= 4.0f, setup.map.halfExtent *= 2.0f;
    setup.outer = lookingAt({0, 0, 3}, {0, 0, 0}, 60.0f);
    setup.indices = {1.5, 2.0};
    const Result result = trace(boxAndFloor({1, 1, 0.2f}, 0.0f), setup);
    for (std::size_t band = 0; band < setup.indices.size(); ++band) {
        const double n = setup.indices[band], kept = 1.0 - (n - 1.0) * (n - 1.0) / ((n + 1.0) * (n + 1.0));
        // Within 1.5 degrees of normal
        EXPECT_NEAR(spot(result, setup, band).flux / setup.emission.extent(), kept * kept, 1e-4) << n;
    }
}

TEST_F(PhotonTraceTest, AbsorptionFollowsTheWayInside) {
    Setup setup;
    setup.emission.halfExtent = glm::vec2(0.1f);
    setup.absorptionPerM = 2.0;
    const double i = glm::radians(40.0), cosT = std::cos(std::asin(std::sin(i) / 1.5));
    const double kept = 1.0 - optics::fresnelDielectric(std::cos(i), 1.0 / 1.5);
    const Result result = trace(boxAndFloor({1.2f, 1.2f, 0.2f}, 40.0f), setup);
    EXPECT_NEAR(spot(result, setup).flux / 0.04, kept * kept * std::exp(-2.0 * 0.4 / cosT), 1e-4);
}

TEST_F(PhotonTraceTest, SharesOfADepositAddUp) {
    for (const int levels : {1, layout::kMostLevels}) {
        Setup setup;
        setup.levels = levels;
        setup.mapSize = 128;
        setup.map.halfExtent = glm::vec2(0.26f);      // photons several texels apart: the pyramid is used
        const Result result = trace(boxAndFloor({1.2f, 1.2f, 0.2f}, 0.0f), setup);
        const double all = std::accumulate(result.map.begin(), result.map.end(), 0.0) / kFixedPerFlux;
        const double kept = 1.0 - 0.04;
        // Eight roundings of at most half a unit for each of 256 photons
        EXPECT_NEAR(all, 0.25 * kept * kept, 1e-6 * 0.25 + 256 * 8 * 0.5 / kFixedPerFlux);
        const auto fine = std::accumulate(result.map.begin(), result.map.begin() + 128 * 128, 0.0);
        if (levels > 1) {
            EXPECT_LT(fine, 0.1 * all * kFixedPerFlux);   // 8 texels apart: levels 3 and 4
        }
    }
}

TEST_F(PhotonTraceTest, GlassThatIsTheOutsideLeavesDirectLight) {
    // Photons through a body of index 1 land where they aimed: concentration 1 in the body's shadow, 0 elsewhere.
    for (const bool perspective : {false, true}) {
        Setup setup;
        setup.emission = perspective ? lookingAt({0, 0, 3}, {0, 0, 0}, 40.0f) : parallelView({0, 0, 3}, {0, 0, 0}, 1.0f);
        setup.map = setup.back = setup.emission;
        setup.outer = setup.emission;
        setup.photons = kSize;
        setup.indices = {1.0};
        setup.xyz = true;
        const float half = 0.5f;
        const Result result = trace(boxAndFloor({half, half, 0.2f}, 0.0f), setup);
        for (int i = 0; i < kSize * kSize; ++i) {
            const glm::vec2 xy = (2.0f * (glm::vec2(i % kSize, i / kSize) + 0.5f) / float(kSize) - 1.0f) * setup.emission.halfExtent;
            const float edge = perspective ? half / 2.8f : half;    // of the upper face
            const float texel = 2.0f * setup.emission.halfExtent.x / kSize, to = std::max(std::abs(xy.x), std::abs(xy.y)) - edge;
            const float expected = to > texel ? 0.0f : 1.0f;
            if (std::abs(to) <= texel) continue;
            // One photon a texel, at its middle: float rounding of its place moves up to 1e-4 of it next door.
            EXPECT_NEAR(result.concentration[std::size_t(i)].y, expected, 1e-3f) << i << (perspective ? " perspective" : " parallel");
        }
    }
}

TEST_F(PhotonTraceTest, TheLedgerClosesAndEachTermIsItsOwn) {
    for (const int levels : {1, layout::kMostLevels}) {
        Setup setup;
        setup.xyz = true;
        setup.levels = levels;
        setup.absorptionPerM = 1.0;
        setup.indices = {1.4, 1.5, 1.6};
        setup.emission.halfExtent = glm::vec2(1.3f);   // more than the box: its sides too
        setup.photons = kSize;
        const Result result = trace(boxAndFloor({0.8f, 0.8f, 0.5f}, 35.0f), setup);
        const auto& rows = result.ledger;
        const double on = rows[layout::kLedgerOnCasters];
        double accounted = 0.0;
        for (const int row : {layout::kLedgerAbsorbed, layout::kLedgerReflected, layout::kLedgerTotalReflection, layout::kLedgerRejected,
                              layout::kLedgerLeftMap, layout::kLedgerNoReceiver, layout::kLedgerDeposited}) {
            accounted += rows[std::size_t(row)];
        }
        EXPECT_NEAR(accounted / on, 1.0, 1e-4);
        EXPECT_GT(rows[layout::kLedgerDeposited], 0.1 * on);
        EXPECT_GT(rows[layout::kLedgerAbsorbed], 0.2 * on);
        EXPECT_GT(rows[layout::kLedgerReflected], 0.05 * on);
        EXPECT_LT(rows[layout::kLedgerRejected], 0.02 * on);
    }
}

TEST_F(PhotonTraceTest, WhatMissesTheInnerMapLandsInTheOuter) {
    Setup setup;
    setup.map.halfExtent = glm::vec2(0.125f);          // a quarter of the beam's area
    const Result result = trace(boxAndFloor({1.2f, 1.2f, 0.2f}, 0.0f), setup);
    const double kept = 0.96 * 0.96, inner = spot(result, setup).flux;
    const double outer = std::accumulate(result.map.begin() + kSize * kSize, result.map.end(), 0.0) / kFixedPerFlux;
    EXPECT_NEAR(inner, 0.25 * 0.25 * kept, 1e-3 * 0.25);
    EXPECT_NEAR(inner + outer, 0.25 * kept, 1e-4 * 0.25);
}

TEST_F(PhotonTraceTest, NoReceiverIsBookedAsSuch) {
    SyntheticScene scene;
    scene.addBox(scene.material(glass()), {-1, -1, -0.2f}, {1, 1, 0.2f});
    Setup setup;
    const Result result = trace(scene, setup);
    EXPECT_EQ(std::accumulate(result.map.begin(), result.map.end(), 0.0), 0.0);
    const auto& rows = result.ledger;
    EXPECT_NEAR(rows[layout::kLedgerNoReceiver] + rows[layout::kLedgerLeftMap], 0.25 * 0.96 * 0.96 * kLedgerPerFlux, 1e-4 * 0.25 * kLedgerPerFlux);
}

TEST_F(PhotonTraceTest, DenseGlassReflectsTotally) {
    // 45 degree faces: light from below the hypotenuse's critical angle cannot leave a right-angle prism of n = 1.6.
    SyntheticScene scene;
    const glm::vec3 a(-1, -1, 0.5f), b(1, -1, 0.5f), c(1, -1, -1.5f), y(0, 2, 0);   // top face, side, hypotenuse c-a
    scene.addFlat(scene.material(glass()), {a, b, b + y, a, b + y, a + y, b, c, c + y, b, c + y, b + y,
                                            c, a, a + y, c, a + y, c + y, a, c, b, a + y, b + y, c + y});
    addFloor(scene);
    Setup setup;
    setup.indices = {1.6};
    const Result result = trace(scene, setup);
    const double entered = 1.0 - std::pow(0.6 / 2.6, 2.0);
    EXPECT_NEAR(result.ledger[layout::kLedgerTotalReflection], 0.25 * entered * kLedgerPerFlux, 1e-4 * 0.25 * kLedgerPerFlux);
    EXPECT_EQ(result.ledger[layout::kLedgerRejected], 0u);
}

}  // namespace
}  // namespace caustream::tests
