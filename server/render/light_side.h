// Everything seen from the light: shadow, photons, spectral map. Its result depends on the scene, the materials, the key
// light and the transport options only, so that it is kept while the camera moves.
#pragma once
#include <glm/mat3x3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "gl/names.h"
#include "gl/shader_library.h"
#include "gl/stage_timer.h"
#include "optics/colour.h"
#include "render/coarse_trace.h"
#include "render/enclosure.h"
#include "render/frame.h"
#include "render/gpu_scene.h"
#include "render/light_views.h"
#include "render/passes/caster_layers.h"
#include "render/passes/map_resolve.h"
#include "render/passes/photon_list.h"
#include "render/passes/photon_trace.h"
#include "render/passes/receiver_depth.h"
#include "render/passes/spectral_step.h"
#include "render/plan.h"
#include "render/spectral_spread.h"

namespace caustream::render {

struct ExactSums;

// What the light did to the scene: the GPU images of one light pose and the numbers that go with them.
struct LightMaps {
    bool hasShadow = false, hasMap = false;
    int castersLit = 0;                    // casters that the light reaches
    bool outerEmpty = false;               // nothing landed in the outer map
    bool lands = false;                    // some of its light lands on a receiver
    View shadowView, mapView, outerView;
    gl::Texture shadow;                    // DEPTH_COMPONENT32F
    gl::Texture map, outerMap;             // RGBA32F concentration
    glm::vec3 landing{0.0f};               // where the caustic lies: the mean of its flux
    optics::WavelengthSet wavelengths;     // traced
    optics::WavelengthSet seen;            // those of the camera's side: the same, or many of a continuous spectrum
    EnergyLedger ledger;
    std::optional<Residuals> residuals;    // when asked for
    std::optional<ErrorEstimate> error;
    std::uint32_t photons = 0;
    std::uint64_t mapHash = 0;             // FNV-1a of the fixed-point map; 0 unless asked for
    std::vector<float> bands;              // [texel][wavelength] concentration, when bands were asked for
    std::vector<float> outerBands;         // Traced: those of the outer map
    std::vector<std::string> warnings;
    std::shared_ptr<ExactSums> exact;      // Traced: what the photons so far add up to (traced_light_side.h)
    std::optional<Convergence> convergence;// Traced: how far that has come
};

// Which casters the light reaches, and the views fitted to where their light lands.
struct LitCaster {
    const scene::Object* caster;
    const scene::Material* material;
    View emission, back;
};
struct LightFit {
    std::vector<LitCaster> casters;
    std::optional<MapViews> views;         // nothing: none of their light lands on a receiver
};

class LightSide {
   public:
    struct Inputs {
        const scene::Scene& scene;
        const GpuScene& gpu;
        const CoarseTrace& tracer;
        const scene::Light& light;         // the key light
        const Transport& transport;        // photonGrid resolved, > 0
        const RenderPlan& plan;
        const Enclosure& enclosure;
        bool bands = false, hash = false;
        bool countResiduals = false;
        optics::Observer observer = optics::Observer::Cie1931;
        Omissions forced{};                // that are done all the same
    };

    explicit LightSide(gl::ShaderLibrary& shaders)
        : casterLayers_(shaders), photonList_(shaders), receiverDepth_(shaders), photonTrace_(shaders), mapResolve_(shaders), spectralStep_(shaders) {}

    // On the CPU alone: what the plan has to know.
    static LightFit fit(const Inputs& in);
    // Submits the passes that the plan runs.
    void run(const Inputs& in, const LightFit& fit, gl::StageTimer& timer, LightMaps& out);
    // Reads ledger and photon count of the last run; waits for the GPU, so call it when the frame is submitted.
    void collect(LightMaps& out) const;

    // Images of the last caster traced, for looking at the passes.
    const gl::Texture& frontLayer() const { return front_; }
    const gl::Texture& receivers() const { return receivers_; }

   private:
    GLuint white();                        // a cookie that changes nothing
    void traceCaster(const Inputs& in, const LitCaster& emitter, std::size_t firstWavelength, std::size_t count,
                     double fixedPerFlux, gl::StageTimer& timer, const LightMaps& out);
    void traceBands(const Inputs& in, const std::vector<LitCaster>& emitters, gl::StageTimer& timer, LightMaps& out);
    void judgeSpectrum(const Inputs& in, const std::vector<LitCaster>& emitters, const LightMaps& out);
    void tracePicture(const Inputs& in, const std::vector<LitCaster>& emitters, gl::StageTimer& timer, LightMaps& out);

    CasterLayers casterLayers_;
    PhotonList photonList_;
    ReceiverDepth receiverDepth_;
    PhotonTrace photonTrace_;
    MapResolve mapResolve_;
    SpectralStep spectralStep_;
    gl::Texture front_, back_, receivers_, outerReceivers_, white_;
    gl::Buffer list_, map_, ledger_, residuals_;
    int batches_ = 1;                      // of wavelengths, in each of which every photon is listed
    double totalFlux_ = 0.0;               // of the last run's emission views, an upper bound of all sums
};

// What the request and the plan trace, of the key light's spectrum.
optics::WavelengthSet wavelengthsOf(const LightSide::Inputs& in);
// Those of the camera's side: the same, or many of a continuous spectrum.
optics::WavelengthSet seenWavelengths(const LightSide::Inputs& in, const optics::WavelengthSet& traced);
// A receiver that stands before nothing, seen from the light.
bool shadesNothing(const LightSide::Inputs& in, const scene::Object& object);
inline constexpr int kShadowSize = 1024;   // texels a side
inline constexpr double kFixedRange = 2147483648.0;   // 2^31: all flux in one word still fits 32 bits, roundings included
inline constexpr double kRoughnessUnit = 16.0;        // of its row in the ledger: map_resolve.comp

}  // namespace caustream::render
