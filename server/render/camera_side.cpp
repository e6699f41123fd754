#include "render/camera_side.h"

#include <algorithm>

namespace caustream::render {

namespace {

// What a frame affords: in motion, at rest (where frames add up), in a still.
constexpr CameraPaths::Settings kMoving{.rays = 2, .bounces = 1, .branches = 1, .least = 1.0f / 32.0f, .caustics = false};
constexpr CameraPaths::Settings kAtRest{.rays = 2, .branches = 1, .least = 1.0f / 64.0f}, kStill{.rays = 8}, kStillOfMany{.rays = 3, .branches = 1, .sample = 1};
constexpr int kSamplesOfOne = 32, kSamplesOfMany = 96;   // a pixel at rest: of one convex caster, of others

// Casters that are drawn, from back to front: refracting ones, where wanted, and thin walls.
std::vector<const scene::Object*> fromBackToFront(const scene::Scene& scene, const View& view, bool refracting, bool thin) {
    std::vector<const scene::Object*> order;
    for (const scene::Object& object : scene.geometry->objects) {
        const scene::Material& material = scene.materials[static_cast<std::size_t>(object.material)];
        if ((refracting && refracts(material, scene.outsideIndex)) || (thin && material.caster && material.thinWalled)) order.push_back(&object);
    }
    std::sort(order.begin(), order.end(), [&](const scene::Object* a, const scene::Object* b) {
        return view.toView(a->bounds.centre()).z < view.toView(b->bounds.centre()).z;
    });
    return order;
}

}  // namespace

void CameraSide::run(const Inputs& in, gl::StageTimer& timer) {
    const Request& request = in.request;
    canvas_ = &canvases_.try_emplace(request.viewer, shaders_).first->second;
    canvas_->inARow = request.target == Target::Composite && (!request.still || in.plan.runs("picture_mean"));
    if (in.plan.runs("picture_mean")) return rest(in, timer);
    CameraPaths::Settings settings = !request.still ? kMoving : in.surfaces && in.surfaces->lone() ? kStill : kStillOfMany;
    settings.bounces = request.still ? request.transport.bounces : std::min(settings.bounces, request.transport.bounces);
    draw(in, settings, timer);
    if (canvas_->inARow) canvas_->progress.move(pictureKey(request), canvas_->color);
    else canvas_->progress.interrupt();
}

// Weights grow as the square of the photons: light of the first frames, which is noisy, soon counts for nothing, without
// the picture ever beginning anew.
void CameraSide::rest(const Inputs& in, gl::StageTimer& timer) {
    const bool lone = in.surfaces->lone();
    const auto sample = canvas_->progress.begin(pictureKey(in.request), in.photons * in.photons, lone ? kSamplesOfOne : kSamplesOfMany, canvas_->color);
    View view = in.view;
    view.shift = 2.0f * sample.shift / glm::vec2(in.width, in.height);
    const Inputs shifted{in.request, in.gpu, view, in.lighting, in.maps, in.plan, in.width, in.height, in.surfaces, in.photons, in.scale};
    CameraPaths::Settings settings = kAtRest;
    if (!lone) {
        // A ray's steps are many, and more rays follow; less is asked of several casters while photons take their time, too.
        settings.rays = 1;
        settings.branches = in.surfaces->casters().size() == 1 || !in.plan.runs("photon_paths") ? 2 : 1;
    }
    settings.bounces = in.request.transport.bounces;
    settings.rotation = sample.rotation;
    settings.sample = canvas_->progress.samples() + 1;
    draw(shifted, settings, timer);
    timer.stage("picture_mean", [&] { canvas_->progress.add(canvas_->color, in.scale); });
}

void CameraSide::keepOnly(std::span<const std::uint64_t> viewers) {
    std::erase_if(canvases_, [&](const auto& canvas) { return std::ranges::find(viewers, canvas.first) == viewers.end(); });
    canvas_ = nullptr;
}

ProgressivePicture::Shown CameraSide::shown(bool exact) const {
    if (canvas_->inARow) return canvas_->progress.shown(exact);
    return {&canvas_->color, nullptr, 1.0f, 1.0f};
}

void CameraSide::draw(const Inputs& in, const CameraPaths::Settings& settings, gl::StageTimer& timer) {
    const scene::Scene& scene = *in.request.scene;
    const bool thesis = in.request.transport.mode == Mode::Thesis, traced = in.plan.runs("camera_paths");
    const char* const shading = thesis ? "thesis_receivers" : "camera_receivers";
    if (in.plan.runs(shading)) {
        timer.stage(shading, [&] {
            receivers_.run({in.gpu, scene.materials, in.lighting, in.view, in.width, in.height, thesis, in.request.forced, in.plan.traced},
                           {canvas_->color, depth_});
        });
    }
    if (!traced) {
        if (in.plan.runs("camera_casters")) seeThrough(in, fromBackToFront(scene, in.view, true, !thesis), timer);   // which has no thin walls
        return;
    }
    // Thin walls behind the solid casters' middle are seen through those, others before them.
    const auto thin = fromBackToFront(scene, in.view, false, true);
    const float middle = in.view.toView(scene.geometry->casterBounds.centre()).z;
    const auto between = std::find_if(thin.begin(), thin.end(), [&](const scene::Object* o) { return in.view.toView(o->bounds.centre()).z >= middle; });
    seeThrough(in, {thin.begin(), between}, timer);
    tracePaths(in, settings, timer);
    seeThrough(in, {between, thin.end()}, timer);
}

void CameraSide::tracePaths(const Inputs& in, const CameraPaths::Settings& settings, gl::StageTimer& timer) {
    const SpectralEntries spectrum = spectralEntries(in.maps.wavelengths);
    const glm::mat3 xyzToRgb(in.maps.wavelengths.xyzToRgb);
    timer.stage("camera_paths", [&] {
        paths_.run({*in.surfaces, spectrum, xyzToRgb, *in.request.scene, in.gpu, in.lighting, in.view, depth_, settings.sample > 0 ? canvas_->progress.mean() : nullptr, in.request.forced.has(Omission::Box)},
                   settings, canvas_->color);
    });
}

void CameraSide::seeThrough(const Inputs& in, const std::vector<const scene::Object*>& order, gl::StageTimer& timer) {
    if (order.empty()) return;
    const Request& request = in.request;
    const scene::Scene& scene = *request.scene;
    const bool thesis = request.transport.mode == Mode::Thesis;
    const char* const through = thesis ? "thesis_refraction" : "dispersive_refraction";
    const bool refracted = in.plan.runs(through);
    if (refracted) timer.stage(through, [&] { thesis ? thesisRefraction_.begin(canvas_->color) : refraction_.begin(canvas_->color); });
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
            if (thesis) return thesisRefraction_.run({in.view, front_, back_, depth_, glass, in.lighting}, canvas_->color);
            refraction_.run({in.view, front_, back_, box, object->bounds, depth_, glass, in.lighting, &casters_.frontDepth()},
                            request.still ? DispersiveRefraction::Settings{transport.backSteps, transport.receiverSteps, 6, true, request.forced}
                                          : DispersiveRefraction::Settings{transport.backSteps, std::min(transport.receiverSteps, 3), 1, false, request.forced},
                            canvas_->color);
        });
    }
}

}  // namespace caustream::render
