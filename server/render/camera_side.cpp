#include "render/camera_side.h"

#include <algorithm>

namespace caustream::render {

void CameraSide::run(const Inputs& in, gl::StageTimer& timer) {
    const bool thesis = in.request.transport.mode == Mode::Thesis;
    const char* const shading = thesis ? "thesis_receivers" : "camera_receivers";
    if (in.plan.runs(shading)) {
        timer.stage(shading, [&] {
            receivers_.run({in.gpu, in.request.scene->materials, in.lighting, in.view, in.width, in.height, thesis, in.request.forced},
                           {color_, depth_});
        });
    }
    if (in.plan.runs("camera_casters")) seeThrough(in, timer);
}

// Casters from back to front, each into the picture of what is behind it.
void CameraSide::seeThrough(const Inputs& in, gl::StageTimer& timer) {
    const Request& request = in.request;
    const scene::Scene& scene = *request.scene;
    const bool thesis = request.transport.mode == Mode::Thesis;
    const char* const through = thesis ? "thesis_refraction" : "dispersive_refraction";
    std::vector<const scene::Object*> order;
    for (const scene::Object& object : scene.geometry->objects) {
        const scene::Material& material = scene.materials[static_cast<std::size_t>(object.material)];
        const bool thin = material.caster && material.thinWalled && !thesis;   // which has none
        if (refracts(material, scene.outsideIndex) || thin) order.push_back(&object);
    }
    std::sort(order.begin(), order.end(), [&](const scene::Object* a, const scene::Object* b) {
        return in.view.toView(a->bounds.centre()).z < in.view.toView(b->bounds.centre()).z;
    });
    const bool refracted = in.plan.runs(through);
    if (refracted) timer.stage(through, [&] { thesis ? thesisRefraction_.begin(color_) : refraction_.begin(color_); });
    for (const scene::Object* object : order) {
        PixelBox box;
        timer.stage("camera_casters", [&] {
            const bool shown = request.target == Target::Pass && request.pass == "camera_casters";
            const bool forced = request.forced.has(Omission::Box) || request.forced.has(Omission::UnseenGlass);
            box = casters_.run({in.gpu, *object, in.view, in.width, in.height, thesis || shown || forced}, {front_, back_});
            if (forced) box = {0, 0, in.width, in.height};
        });
        if (box.empty() || !refracted) continue;
        const scene::Material& material = scene.materials[static_cast<std::size_t>(object->material)];
        DispersiveRefraction::Glass glass;
        glass.thinWalled = material.thinWalled;
        glass.tint = glm::vec3(material.baseColor);
        const optics::WavelengthSet& set = in.maps.seen;
        const Transport& transport = request.transport;
        for (std::size_t i = 0; i < set.nm.size(); ++i) {
            glass.wavelengths.push_back({static_cast<float>(optics::refractiveIndex(material.dispersion, set.nm[i]) / scene.outsideIndex),
                                         glm::vec3(set.xyzToRgb * set.xyz[i]), static_cast<float>(material.absorption.at(set.nm[i]))});
        }
        timer.stage(through, [&] {
            if (thesis) return thesisRefraction_.run({in.view, front_, back_, depth_, glass, in.lighting}, color_);
            refraction_.run({in.view, front_, back_, box, object->bounds, depth_, glass, in.lighting, &casters_.frontDepth()},
                            request.still ? DispersiveRefraction::Settings{transport.backSteps, transport.receiverSteps, 6, true, request.forced}
                                          : DispersiveRefraction::Settings{transport.backSteps, std::min(transport.receiverSteps, 3), 1, false, request.forced},
                            color_);
        });
    }
}

}  // namespace caustream::render
