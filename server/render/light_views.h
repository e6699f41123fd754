// The views from the light, each fitted to what it is for (Blanchette 2012 has one for everything, and spends most of it
// on darkness).
#pragma once
#include <optional>
#include <span>

#include "render/coarse_trace.h"
#include "render/view.h"
#include "scene/scene.h"

namespace caustream::render {

// Photon grid and front layer: the caster's bounds intersected with the light's cone. Nothing when the cone misses it.
std::optional<View> emissionView(const scene::Scene& scene, const scene::Light& light, const scene::Object& caster);

// Back layer: all of the caster, as refracted light leaves it outside the cone too.
View backView(const scene::Scene& scene, const scene::Light& light, const scene::Object& caster);

struct MapViews {
    View inner;             // the smallest rolled rectangle that takes 99.5% (traced: fewer) of the flux
    View outer;             // same axis, wider: what lands outside the inner one
    glm::vec3 landing;      // mean of the flux, world space
};
inline constexpr double kLeftOut[] = {0.005};   // of the flux, given to the outer map
// Fitted to where light lands; nothing when it lands nowhere. A function of its arguments alone, so that equal input
// gives equal bits whatever came before. Of several `leftOutShares` the one whose texels are narrowest in the mean over all
// light, where a texel of the outer map, were it as wide as the inner, counts `outerWidth` times one of the inner.
std::optional<MapViews> mapViews(const scene::Scene& scene, const scene::Light& light, std::span<const Landing> landings,
                                 std::span<const double> leftOutShares = kLeftOut, double outerWidth = 0.0);

// The light's cone (at most 120 degrees across), or the frustum towards the casters for a point light.
View shadowView(const scene::Scene& scene, const scene::Light& light);

// The published algorithm's one view for everything: the cone. For a light whose cone does not hold its own caustic (less
// than nine tenths of it) a view that holds the caustic and the `emissions`, aimed as the thesis's scenes are lit: facing
// the receiver, where its five steps to the receiver settle.
View wholeView(const scene::Scene& scene, const scene::Light& light, std::span<const Landing> landings,
               std::span<const View> emissions);

}  // namespace caustream::render
