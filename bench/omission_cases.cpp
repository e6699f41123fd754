#include "bench/omission_cases.h"

#include <glm/geometric.hpp>
#include <utility>

#include "error.h"
#include "scene/builtin_scenes.h"

namespace caustream::bench {

namespace {

using render::Omission;

scene::Scene builtin(const char* name) {
    auto loaded = scene::loadBuiltin(name);
    if (!loaded) throw Error(loaded.error().message);
    return std::move(*loaded);
}

// The scene's casters of glass whose index is the same for all colours.
scene::Scene colourless(scene::Scene scene) {
    for (scene::Material& material : scene.materials) {
        if (material.caster) material.dispersion = optics::ConstantIndex{1.5};
    }
    return scene;
}

scene::Scene lampTurnedAway(scene::Scene scene) {
    for (scene::Light& light : scene.lights) light.direction = -light.direction;
    return scene;
}

// The first receiver alone, which in the boxed scenes is the floor.
scene::Scene floorAlone(scene::Scene scene) {
    auto geometry = std::make_shared<scene::Geometry>(*scene.geometry);
    std::erase_if(geometry->objects, [&](const scene::Object& object) { return object.name != "floor"; });
    geometry->casterBounds = {};
    scene.geometry = geometry;
    return scene;
}

// A white cookie-less, texture-less picture of the scene as its camera has it.
render::Request pictureOf(scene::Scene scene, int size, int photonGrid) {
    render::Request request;
    request.camera = scene.cameras.front();
    request.width = request.height = request.transport.mapSize = size;
    request.transport.photonGrid = photonGrid;
    request.transport.wavelengths = 7;
    request.scene = std::make_shared<const scene::Scene>(std::move(scene));
    return request;
}

}  // namespace

render::Request OmissionCase::moved(int step) const {
    render::Request next = request;
    const float by = 1e-4f * static_cast<float>(step);
    if (moves == Moves::Camera) {
        next.camera.eye.x += by;
        return next;
    }
    scene::Scene moved = *request.scene;
    for (scene::Light& light : moved.lights) light.position.x += by;
    next.scene = std::make_shared<const scene::Scene>(std::move(moved));
    return next;
}

std::vector<OmissionCase> omissionCases(int size, int photonGrid) {
    const auto picture = [&](scene::Scene scene) { return pictureOf(std::move(scene), size, photonGrid); };
    const render::Request sphere = picture(builtin("sphere")), clear = picture(colourless(builtin("sphere")));
    render::Request aside = sphere, map = sphere;
    aside.camera.target = aside.camera.eye + glm::vec3(3, 0, -1);   // at the wall beside the sphere
    map.target = render::Target::Spectral;
    map.sample = render::Sample::F32;
    return {
        {Omission::UnchangedLight, sphere, Moves::Camera},
        {Omission::UnlitGlass, picture(lampTurnedAway(builtin("sphere"))), Moves::Light},
        {Omission::Colours, clear, Moves::Light, 2, "seven roundings of a photon's flux in place of one"},
        {Omission::NoShadow, picture(floorAlone(builtin("sphere"))), Moves::Light},
        {Omission::Walls, sphere, Moves::Light, 1, "in a crease a wall's texel shaded the next wall, wrongly; more of 255 where a larger picture shows the crease's pixels"},
        {Omission::Absorption, sphere, Moves::Light, 1, "the driver's exp(0) is 1 to a few units in the last place"},
        {Omission::OneWavelength, clear, Moves::Light, 1, "a mean over one value is divided by its weight"},
        {Omission::Cookie, sphere, Moves::Light, 1, "white's luminance is 1 to one unit in the last place"},
        {Omission::Textures, sphere, Moves::Camera},
        {Omission::Gloss, sphere, Moves::Camera},
        {Omission::ShadowLookup, sphere, Moves::Camera},
        {Omission::MapLookup, sphere, Moves::Camera},
        {Omission::OuterMap, picture(builtin("prism")), Moves::Camera},
        {Omission::UnseenGlass, aside, Moves::Camera},
        {Omission::Box, sphere, Moves::Camera},
        {Omission::Picture, map, Moves::Light},
    };
}

}  // namespace caustream::bench
