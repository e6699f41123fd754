#include "render/passes/camera_casters.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace caustream::render {

PixelBox projectedBox(const scene::Bounds& bounds, const View& view, int width, int height) {
    if (bounds.empty()) return {};
    glm::vec2 low(1e30f), high(-1e30f);
    int behind = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 world(corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                              corner & 4 ? bounds.max.z : bounds.min.z);
        const glm::vec3 pos = view.toView(world);
        if (view.perspective && -pos.z <= view.nearM) {
            ++behind;
            continue;
        }
        const glm::vec2 xy = (view.perspective ? glm::vec2(pos) / -pos.z : glm::vec2(pos)) / view.halfExtent;
        low = glm::min(low, xy);
        high = glm::max(high, xy);
    }
    if (behind == 8) return {};
    if (behind > 0) return {0, 0, width, height};  // the eye is beside or inside: its image has no bounds

    // Clamped before the conversion: a corner just before the eye projects beyond what an int holds.
    const auto pixel = [](float ndc, int size) { return (0.5f + 0.5f * glm::clamp(ndc, -2.0f, 2.0f)) * float(size); };
    const int left = std::max(0, int(std::floor(pixel(low.x, width))) - 1);
    const int bottom = std::max(0, int(std::floor(pixel(low.y, height))) - 1);
    const int right = std::min(width, int(std::ceil(pixel(high.x, width))) + 1);
    const int top = std::min(height, int(std::ceil(pixel(high.y, height))) + 1);
    if (right <= left || top <= bottom) return {};
    return {left, bottom, right - left, top - bottom};
}

PixelBox CameraCasters::run(const Inputs& in, const Outputs& out) {
    const PixelBox box = projectedBox(in.caster.bounds, in.view, in.width, in.height);
    if (box.empty() && !in.clearAll) return box;
    if (!in.clearAll) {
        glEnable(GL_SCISSOR_TEST);
        glScissor(box.x, box.y, box.width, box.height);
    }
    const CasterLayers::Inputs layers{in.scene, in.caster, in.view, in.width, in.height, nullptr};
    layers_.run(layers, CasterLayers::Side::Back, out.back);
    layers_.run(layers, CasterLayers::Side::Front, out.front);   // last: its depth stays
    glDisable(GL_SCISSOR_TEST);
    return box;
}

}  // namespace caustream::render
