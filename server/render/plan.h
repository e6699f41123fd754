// What this scene and this request need, pass by pass, and why.
#pragma once
#include <string>
#include <vector>

#include "render/frame.h"

namespace caustream::render {

struct PlanFacts {
    bool lightCached = false;           // the maps of this light pose are there already
    int casters = 0;                    // that refract: index or absorption differs from the outside
    int idleCasters = 0;                // whose glass is the outside: nothing happens there
    int thinWalled = 0;
    bool dispersive = false;            // some caster's index depends on the wavelength
    bool shadowCasters = false;         // something can stand between the light and a receiver
    bool castersInCamera = false;
};

struct RenderPlan {
    std::vector<PlanEntry> entries;     // in the order of execution
    int wavelengths = 1;                // traced per photon, on the light's side and the camera's
    std::string wavelengthReason;

    bool runs(const std::string& pass) const;
};

// The passes' names in order are those of passNames().
RenderPlan makePlan(const PlanFacts& facts, const Request& request);

// Whether light changes at the caster's surface or inside: index within 1e-6 of the outside's and no absorption is none.
bool refracts(const scene::Material& material, double outsideIndex);

}  // namespace caustream::render
