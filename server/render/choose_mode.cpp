#include "render/choose_mode.h"

#include <algorithm>

#include "render/plan.h"

namespace caustream::render {

ModeChoice chooseMode(const Request& request, std::span<const ExactCaster> casters) {
    if (request.transport.mode != Mode::Auto) return {request.transport.mode, {}, false};
    const scene::Scene& scene = *request.scene;
    const bool any = std::any_of(casters.begin(), casters.end(), [&](const ExactCaster& caster) {
        return caster.mirror || refracts(scene.materials[static_cast<std::size_t>(scene.geometry->objects[caster.object].material)], scene.outsideIndex);
    });
    if (!any) return {Mode::Refined, "no caster bends light: nothing to trace exactly", false};
    if (request.countResiduals) return {Mode::Refined, "its searches' residuals are asked for", false};
    const auto mesh = std::find_if(casters.begin(), casters.end(), [](const ExactCaster& caster) { return !caster.convex; });
    if (mesh == casters.end()) return {Mode::Traced, "every caster is a set of planes, traced exactly at once (" + casters.front().why + ")", false};
    if (request.converge) return {Mode::Traced, "nothing moves: traced exactly, until it converges", false};
    return {Mode::Refined, "a mesh is refined while it moves (" + mesh->why + ")", true};
}

}  // namespace caustream::render
