// What this scene and this request need, pass by pass, and why.
#pragma once
#include <string>
#include <vector>

#include "render/enclosure.h"
#include "render/frame.h"
#include "render/view.h"

namespace caustream::render {

struct PlanFacts {
    bool lightCached = false;           // the maps of this light pose are there already
    int casters = 0;                    // that refract: index or absorption differs from the outside
    int idleCasters = 0;                // whose glass is the outside: nothing happens there
    int thinWalled = 0;
    int castersLit = 1;                 // of `casters`, in the light
    bool lands = true;                  // some of the light that passes them lands on a receiver
    bool dispersive = false;            // some caster's index or absorption depends on the wavelength
    bool absorbing = false;             // some caster that refracts absorbs
    int receivers = 0;
    bool shadowCasters = false;         // a receiver can stand between the light and another
    int walls = 0;                      // receivers that cannot
    bool receiversTextured = false, receiversGlossy = false;
    int receiversInShadow = 0, receiversInMap = 0;   // that have a part in the shadow's view, in the map's
    bool outerEmpty = false;            // no light landed outside the inner map
    bool lines = false;                 // the key light shines at single wavelengths
    bool cookie = false;                // of the key light
    int lights = 1;
    bool castersInCamera = false;
    int glass = 0, glassInCamera = 0;   // casters that are drawn: refracting or thin-walled
    double boxShare = 0.0;              // of the picture's pixels, in the boxes of the casters in view
    int receiverTriangles = 0;
    int mirrors = 0;                    // casters of traced transport only
    std::string modeReason;             // why this transport, where that was left to us
    bool refinedCamera = false;         // Traced: the camera moves past meshes whose light rests
    bool adding = false;                // Traced: photons are added to the map that is there
    int continuousNodes = 4;            // exact wavelengths that this machine affords a continuous spectrum
};

struct RenderPlan {
    std::vector<PlanEntry> entries;     // in the order of execution
    int wavelengths = 1;                // traced per photon
    bool continuous = false;            // and all that lies between them, on the light's side and the camera's
    std::string wavelengthReason;
    int casters = 0;                    // that refract
    bool shadow = false;                // something throws one
    bool traced = false;                // exact transport: photon_paths, camera_paths
    bool exactReceivers = false;        // met triangle by triangle: asked for, few, or one can stand before a caster
    bool hidden = true;                 // a receiver may hide another from the light

    bool runs(const std::string& pass) const;
};

// The passes' names in order are those of passNames().
RenderPlan makePlan(const PlanFacts& facts, const Request& request);

// A sentence, where no light that passes a caster lands.
std::string whyNoCaustic(const PlanFacts& facts);

// How many wavelengths the light needs, whether all between them too, and why.
void chooseWavelengths(RenderPlan& plan, const PlanFacts& facts, const Request& request);

// The rows of the camera's passes; `caustics`: there is a map to look up. Any mode's plan ends with them.
void addCameraSide(RenderPlan& plan, const PlanFacts& facts, const Request& request, bool caustics);

// What can be told of a request without drawing: all but what depends on where the light lands.
PlanFacts gatherFacts(const Request& request, const scene::Light& key, const View& camera, const Enclosure& enclosure);

// Whether light changes at the caster's surface or inside: index within 1e-6 of the outside's and no absorption is none.
bool refracts(const scene::Material& material, double outsideIndex);
bool absorbs(const scene::Material& material);

}  // namespace caustream::render
