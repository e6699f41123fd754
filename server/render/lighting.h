// The lights as the camera's receivers see them: the key light with its shadow and spectral map, the others direct only.
#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "render/view.h"
#include "scene/scene.h"

namespace caustream::render {

struct Lighting {
    std::vector<scene::Light> lights;    // [0] is the key light: the strongest, the one that throws caustics
    glm::vec3 keyRgb{1.0f};              // spectrum's own colour times Light::color, linear BT.709
    std::vector<glm::vec3> rgb;          // the same for every light, in the order of `lights`
    float referenceIrradiance = 1.0f;    // W m^-2 (or lx): of all lights on a white receiver facing them at the
                                         // scene's centre of interest; exposure and environment are relative to it
    glm::vec3 environmentRadiance{0.0f}; // Scene::environmentColor * referenceIrradiance / pi

    bool hasShadow = false;
    View shadowView;                     // depth texture, key light's
    GLuint shadowDepth = 0;              // DEPTH_COMPONENT32F, reversed
    bool hasMap = false;
    bool hasOuterMap = true;             // some light landed there
    View mapView, outerView;             // of the inner and the coarse outer spectral map: one eye, one orientation
    GLuint map = 0, outerMap = 0;        // RGBA32F, rgb concentration (1 = as bright as direct light), uv of their view;
                                         // a layer value of the receiver there (1 unknown). Outer: what the inner misses
};

}  // namespace caustream::render
