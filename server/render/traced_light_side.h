// The light's side of traced transport: exact photons, added to a light pose's map in as many frames as one likes. Fills
// the same LightMaps as LightSide does, in the same units.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "render/exact_surfaces.h"
#include "render/light_side.h"
#include "render/passes/map_adapt.h"
#include "render/passes/map_resolve.h"
#include "render/passes/photon_paths.h"
#include "render/passes/receiver_depth.h"
#include "render/spectral_table.h"

namespace caustream::render {

// A caster that light meets first, and the view that it is aimed at by.
struct ExactEmitter {
    int caster = 0;                        // its number in the shaders
    View emission;
    double extent = 0.0;                   // of the view, were all of it as bright as its brightest place
};

// Sums of 64 bits, in a unit that is fixed: any partition of the same photons gives the same ones.
struct ExactSums {
    gl::Buffer map, outerMap;              // kWideWords a texel (bands: 2 a band)
    gl::Buffer landings, outerLandings;    // u32 a texel
    gl::Texture receivers, outerReceivers; // receiver_depth of the two views
    std::vector<ExactEmitter> emitters;
    SpectralTable table;
    SpectralEntries entries;
    int spectra = 1;                       // wavelengths a photon
    double extent = 0.0;                   // of all emitters
    double fixedPerFlux = 1.0;             // units of the sums per photon's flux
    std::uint64_t photons = 0;             // sent out so far, whether or not they met their caster
    double met = 1.0;                      // share of them that meet their caster
    std::uint64_t milestone = 0;           // photons after which it is next asked whether that is enough
    std::array<double, layout::kLedgerRows> ledger{};   // in photons
};

// Where convergence ends: relative L1, 1% unless asked for.
double targetOf(const Transport& transport);

class TracedLightSide {
   public:
    struct Inputs {
        const LightSide::Inputs& light;
        const ExactSurfaces& surfaces;
        bool software = false;             // which number of photons a frame affords
    };

    explicit TracedLightSide(gl::ShaderLibrary& shaders)
        : receiverDepth_(shaders), photonPaths_(shaders), adapt_{MapAdapt(shaders), MapAdapt(shaders)}, resolve_{MapResolve(shaders), MapResolve(shaders)} {}

    // On the CPU alone: which casters the light meets first, and where it lands after.
    struct Fit {
        std::vector<ExactEmitter> emitters;
        std::optional<MapViews> views;     // nothing: none of their light lands on a receiver
        double met = 1.0;                  // share of the photons sent out that meet their caster
    };
    static Fit fit(const Inputs& in);

    // A light pose's first photons.
    void begin(const Inputs& in, const Fit& fit, gl::StageTimer& timer, LightMaps& out);
    // More of them, as many as a frame has time for. Not for bands.
    void add(const Inputs& in, gl::StageTimer& timer, LightMaps& out);
    // What a still is worth: the photons that its first frame would have had, and a hash of the sums, which are read back.
    void complete(const Inputs& in, gl::StageTimer& timer, LightMaps& out);
    // Reads the last run's ledger; waits for the GPU, so call it when the frame is submitted.
    void collect(const Inputs& in, LightMaps& out);

   private:
    std::uint64_t firstPhotons(const Inputs& in, double met) const;
    void hash(const Inputs& in, LightMaps& out) const;
    void trace(const Inputs& in, std::uint64_t photons, int firstEntry, int entries, gl::StageTimer& timer, LightMaps& out);
    void resolve(const Inputs& in, gl::StageTimer& timer, LightMaps& out);
    void traceBands(const Inputs& in, std::uint64_t photons, gl::StageTimer& timer, LightMaps& out);

    ReceiverDepth receiverDepth_;
    PhotonPaths photonPaths_;
    std::array<MapAdapt, 2> adapt_;        // of the inner map, of the outer: each keeps images of its own size
    std::array<MapResolve, 2> resolve_;
    std::array<KeptLevels, 2> kept_;
    gl::Buffer ledger_;
    std::uint64_t tracedNow_ = 0;          // photons of this frame
    double ledgerPerFlux_ = 1.0, ledgerPerFixed_ = 1.0;
    std::uint64_t startedNs_ = 0;          // when this frame's photons were sent
    std::uint64_t sentNs_ = 0;             // when the call that traces them returned
    double msPerPhoton_ = 0.0;             // of the newest frame that traced, all that its map took
    double tracingMsPerPhoton_ = 0.0;      // of its photons alone
};

}  // namespace caustream::render
