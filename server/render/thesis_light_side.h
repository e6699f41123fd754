// The light's side as published (Blanchette 2012, figure 25, passes 1 to 4): one view from the light for everything, a
// photon hierarchy, splats. Fills the same LightMaps as LightSide does, in the same units.
#pragma once
#include <vector>

#include "gl/names.h"
#include "gl/shader_library.h"
#include "gl/stage_timer.h"
#include "render/light_side.h"
#include "render/passes/caster_layers.h"
#include "render/passes/photon_hierarchy.h"
#include "render/passes/photon_splat.h"
#include "render/passes/receiver_depth.h"

namespace caustream::render {

class ThesisLightSide {
   public:
    explicit ThesisLightSide(gl::ShaderLibrary& shaders)
        : casterLayers_(shaders), hierarchy_(shaders), receiverDepth_(shaders), splat_(shaders) {}

    // Submits the passes that the plan runs. `hash`: also the ledger, as far as this transport can tell (flux on casters
    // and in the map), and a hash of the map's floats; both read the map back.
    void run(const LightSide::Inputs& in, gl::StageTimer& timer, LightMaps& out);
    // Reads the last run's photon count; call it when the frame is submitted.
    void collect(LightMaps& out) const;

    const gl::Texture& frontLayer() const { return front_; }
    const gl::Texture& receivers() const { return receivers_; }

   private:
    struct Target;                         // a map image, the wavelengths that it takes, and their weights
    View findView(const LightSide::Inputs& in, LightMaps& out, std::vector<const scene::Object*>& casters) const;
    std::vector<Target> makeTargets(const LightSide::Inputs& in, LightMaps& out);
    void traceCaster(const LightSide::Inputs& in, const scene::Object& caster, std::size_t index, const View& view,
                     const std::vector<Target>& targets, gl::StageTimer& timer);
    void readBack(const LightSide::Inputs& in, const std::vector<Target>& targets, double onCasters, LightMaps& out) const;
    double fluxOn(const LightSide::Inputs& in, const View& view) const;

    CasterLayers casterLayers_;
    PhotonHierarchy hierarchy_;
    ReceiverDepth receiverDepth_;
    PhotonSplat splat_;
    gl::Texture front_, back_, receivers_;
    std::vector<gl::Texture> bandMaps_;    // RGBA32F, four bands each
    std::vector<gl::Query> photons_;       // one for each caster
    std::size_t casters_ = 0;              // traced in the last run
};

}  // namespace caustream::render
